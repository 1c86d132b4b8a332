// What the tests call of the mechanism in double, with their assertions on, and not the archive's.
#include "sms/compiled_mechanism.hpp"

SMS_MECHANISM_IN_DOUBLE(template)
