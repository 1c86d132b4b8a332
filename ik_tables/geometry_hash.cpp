#include "geometry_hash.hpp"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <set>

#include "sms/geometry.hpp"
#include "text.hpp"

namespace ik_tables {
namespace {

// Whether the geometry depends on a parameter is not declared anywhere: it is tried.
bool shapes_geometry(const sms::Params<double>& params, int index) {
  sms::Params<double> other = params;
  sms::param(other, index) += 1e-3;
  const sms::Geometry<double> a = sms::make_geometry(params), b = sms::make_geometry(other);
  return std::memcmp(&a, &b, sizeof a) != 0;
}

}  // namespace

std::string geometry_hash(const sms::Params<double>& params) {
  std::set<std::string> lines;
  for (int i = 0; i < sms::param_count; ++i) {
    if (shapes_geometry(params, i)) {
      lines.insert(std::string(sms_param_describe(i)->name) + "=" + text(sms::param(params, i)) + "\n");
    }
  }
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::string& line : lines) {
    for (const char c : line) {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
  }
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace ik_tables
