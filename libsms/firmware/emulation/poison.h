/* Included before a source of the firmware, it forbids what a C28x does not have or firmware does not do: types of 8
 * bits, the width of char, double, heap and stdio. Headers that name them for others (those of the core that serve the desk too) come
 * first. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>

#include "sms/forward_kinematics.hpp"
#include "sms/inverse_kinematics.hpp"

#undef CHAR_BIT
#undef UCHAR_MAX
#pragma GCC poison uint8_t int8_t uint_least8_t int_least8_t uint_fast8_t int_fast8_t CHAR_BIT UCHAR_MAX
#pragma GCC poison double long_double
#pragma GCC poison malloc calloc realloc free printf snprintf fopen abort exit
#pragma GCC poison throw try catch dynamic_cast typeid virtual
