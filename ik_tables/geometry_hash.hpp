#pragma once

#include <string>

#include "sms/params.hpp"

namespace ik_tables {

// Tells tables of different mechanisms apart: FNV-1a, 64 bits, in hexadecimal, of lines "name=value\n" with every
// parameter that the geometry depends on, in the order of the alphabet, values as the shortest decimal number that
// reads back as the same double.
std::string geometry_hash(const sms::Params<double>& params);

}  // namespace ik_tables
