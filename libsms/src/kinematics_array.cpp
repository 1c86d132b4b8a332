// Many poses at once: four side by side where the processor can, one after the other else; the same bits either way.
#include <cstddef>

#include "sms/inverse_kinematics.hpp"
#include "sms/kinematics.h"
#include "sms/lanes.hpp"

#define SMS_REAL double
#define SMS_F(name) name
#include "abi_structs.inc"

namespace {

using sms::Lanes;

// n rows of both directions, as sms/kinematics.h has them.
struct Rows {
  std::size_t n;
  const sms_geometry* geometry;
  const double* given;  // three numbers a row
  const sms_pose* start;
  sms_pose* pose;
  double* extension;  // of the inverse; NULL otherwise
  sms_convergence* convergence;
  sms_status* status;

  const sms_pose* start_of(std::size_t i) const { return start != nullptr ? start + i : nullptr; }
  sms_convergence* convergence_of(std::size_t i) const { return convergence != nullptr ? convergence + i : nullptr; }
};

struct Inverse {
  static sms_status one(const Rows& rows, std::size_t i) {
    return sms_inverse_kinematics(rows.geometry, rows.given + 3 * i, rows.start_of(i), rows.pose + i,
                                  rows.extension + 3 * i, rows.convergence_of(i));
  }
  static sms_status four(const sms::Geometry<Lanes>& g, const sms::Vec3<Lanes>& q, const sms::Pose<Lanes>& start,
                         sms::Pose<Lanes>& pose, sms::Vec3<Lanes>& extension, sms::Convergence<Lanes>* convergence) {
    return sms::inverse_kinematics(g, q, start, pose, extension, convergence);
  }
};

struct Forward {
  static sms_status one(const Rows& rows, std::size_t i) {
    return sms_forward_kinematics(rows.geometry, rows.given + 3 * i, rows.start_of(i), rows.pose + i,
                                  rows.convergence_of(i));
  }
  static sms_status four(const sms::Geometry<Lanes>& g, const sms::Vec3<Lanes>& extension,
                         const sms::Pose<Lanes>& start, sms::Pose<Lanes>& pose, sms::Vec3<Lanes>& /*given*/,
                         sms::Convergence<Lanes>* convergence) {
    return sms::forward_kinematics(g, extension, start, pose, convergence);
  }
};

#if defined(__GNUC__) && defined(__x86_64__)
bool takes_four() { return __builtin_cpu_supports("avx2") != 0; }

// Column k of four rows of so many numbers.
inline Lanes column(const double* rows, int width, int k) {
  return Lanes(Lanes::Numbers{rows[k], rows[width + k], rows[2 * width + k], rows[3 * width + k]});
}

inline sms::Pose<Lanes> side_by_side(const sms_pose* poses) {
  const double* const p = &poses->roll;
  return {column(p, 6, 0), column(p, 6, 1), column(p, 6, 2), column(p, 6, 3), column(p, 6, 4), column(p, 6, 5)};
}

// Row i and the three after it; false where one of them has no solution, and nothing is written then.
template <typename Direction>
inline bool solve_four(const sms::Geometry<Lanes>& geometry, const sms::Pose<Lanes>& rest, const Rows& rows,
                       std::size_t i) {
  const double* const given = rows.given + 3 * i;
  const bool ask = rows.convergence != nullptr;
  sms::Pose<Lanes> pose;
  sms::Vec3<Lanes> extension = sms::Vec3<Lanes>::Zero();
  sms::Convergence<Lanes> convergence;
  const sms_status status = Direction::four(
      geometry, sms::Vec3<Lanes>(column(given, 3, 0), column(given, 3, 1), column(given, 3, 2)),
      rows.start != nullptr ? side_by_side(rows.start + i) : rest, pose, extension, ask ? &convergence : nullptr);
  if (status != SMS_OK) {
    return false;
  }
  for (int l = 0; l < Lanes::count; ++l) {
    const std::size_t row = i + std::size_t(l);
    rows.status[row] = SMS_OK;
    rows.pose[row] = {pose.roll.at[l], pose.pitch.at[l], pose.height.at[l], pose.yaw.at[l], pose.x.at[l], pose.y.at[l]};
    for (int k = 0; rows.extension != nullptr && k < 3; ++k) {
      rows.extension[3 * row + std::size_t(k)] = extension(k).at[l];
    }
    if (ask) {
      rows.convergence[row] = {int(convergence.iterations.at[l]), convergence.residual.at[l]};
    }
  }
  return true;
}

// As many fours as there are; gives the first row that is left. Everything is compiled into this function, for AVX2,
// and nothing else of the library is.
template <typename Direction>
__attribute__((target("avx2"), flatten)) std::size_t solve_fours(const Rows& rows) {
  const sms::Geometry<Lanes> geometry = sms::in_lanes(*reinterpret_cast<const sms::Geometry<double>*>(rows.geometry));
  const sms::Pose<Lanes> rest = sms::rest_pose(geometry);
  std::size_t i = 0;
  for (; i + Lanes::count <= rows.n; i += Lanes::count) {
    if (!solve_four<Direction>(geometry, rest, rows, i)) {
      for (std::size_t k = i; k < i + Lanes::count; ++k) {
        rows.status[k] = Direction::one(rows, k);
      }
    }
  }
  return i;
}
#else
bool takes_four() { return false; }
template <typename Direction>
std::size_t solve_fours(const Rows& /*rows*/) {
  return 0;
}
#endif

template <typename Direction>
sms_status solve(const Rows& rows) {
  for (std::size_t i = takes_four() ? solve_fours<Direction>(rows) : 0; i < rows.n; ++i) {
    rows.status[i] = Direction::one(rows, i);
  }
  for (std::size_t i = 0; i < rows.n; ++i) {
    if (rows.status[i] != SMS_OK) {
      return rows.status[i];
    }
  }
  return SMS_OK;
}

}  // namespace

extern "C" {

sms_status sms_inverse_kinematics_array(const sms_geometry* geometry, size_t n, const double* q, const sms_pose* start,
                                        sms_pose* pose, double* extension, sms_convergence* convergence,
                                        sms_status* status) {
  return solve<Inverse>({n, geometry, q, start, pose, extension, convergence, status});
}

sms_status sms_forward_kinematics_array(const sms_geometry* geometry, size_t n, const double* extension,
                                        const sms_pose* start, sms_pose* pose, sms_convergence* convergence,
                                        sms_status* status) {
  return solve<Forward>({n, geometry, extension, start, pose, nullptr, convergence, status});
}

}  // extern "C"
