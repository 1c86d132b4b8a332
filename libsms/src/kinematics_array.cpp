// Many poses at once: eight or four side by side where the processor can, one after the other else; the same bits anyway.
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
  template <typename L>
  static sms_status side_by_side(const sms::Geometry<L>& g, const sms::Vec3<L>& q, const sms::Pose<L>& start,
                                 sms::Pose<L>& pose, sms::Vec3<L>& extension, sms::Convergence<L>* convergence) {
    return sms::inverse_kinematics(g, q, start, pose, extension, convergence);
  }
};

struct Forward {
  static sms_status one(const Rows& rows, std::size_t i) {
    return sms_forward_kinematics(rows.geometry, rows.given + 3 * i, rows.start_of(i), rows.pose + i,
                                  rows.convergence_of(i));
  }
  template <typename L>
  static sms_status side_by_side(const sms::Geometry<L>& g, const sms::Vec3<L>& extension, const sms::Pose<L>& start,
                                 sms::Pose<L>& pose, sms::Vec3<L>& /*given*/, sms::Convergence<L>* convergence) {
    return sms::forward_kinematics(g, extension, start, pose, convergence);
  }
};

#if defined(__GNUC__) && defined(__x86_64__)
// Column k of some rows of so many numbers.
template <int N>
inline Lanes<N> column(const double* rows, int width, int k) {
  Lanes<N> numbers;
  for (int l = 0; l < N; ++l) {
    numbers.at[l] = rows[l * width + k];
  }
  return numbers;
}

template <int N>
inline sms::Pose<Lanes<N>> poses_from(const sms_pose* poses) {
  const double* const p = &poses->roll;
  return {column<N>(p, 6, 0), column<N>(p, 6, 1), column<N>(p, 6, 2),
          column<N>(p, 6, 3), column<N>(p, 6, 4), column<N>(p, 6, 5)};
}

// Row i and those after it that are taken with it; false where one of them has no solution, and nothing is written then.
template <typename Direction, int N>
inline bool solve_at(const sms::Geometry<Lanes<N>>& geometry, const sms::Pose<Lanes<N>>& rest, const Rows& rows,
                     std::size_t i) {
  const double* const given = rows.given + 3 * i;
  const bool ask = rows.convergence != nullptr;
  sms::Pose<Lanes<N>> pose;
  sms::Vec3<Lanes<N>> extension = sms::Vec3<Lanes<N>>::Zero();
  sms::Convergence<Lanes<N>> convergence;
  const sms_status status = Direction::side_by_side(
      geometry, sms::Vec3<Lanes<N>>(column<N>(given, 3, 0), column<N>(given, 3, 1), column<N>(given, 3, 2)),
      rows.start != nullptr ? poses_from<N>(rows.start + i) : rest, pose, extension, ask ? &convergence : nullptr);
  if (status != SMS_OK) {
    return false;
  }
  for (int l = 0; l < N; ++l) {
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

// Rows from `first` on, as many at a time as there are lanes; gives the first row that is left.
template <typename Direction, int N>
inline std::size_t solve_wide(const Rows& rows, std::size_t first) {
  const auto geometry = sms::in_lanes<N>(*reinterpret_cast<const sms::Geometry<double>*>(rows.geometry));
  const sms::Pose<Lanes<N>> rest = sms::rest_pose(geometry);
  std::size_t i = first;
  for (; i + N <= rows.n; i += N) {
    if (!solve_at<Direction, N>(geometry, rest, rows, i)) {
      for (std::size_t k = i; k < i + N; ++k) {
        rows.status[k] = Direction::one(rows, k);
      }
    }
  }
  return i;
}

// Everything is compiled into these two functions, for AVX2 and for AVX-512, and nothing else of the library is.
template <typename Direction>
__attribute__((target("avx2"), flatten)) std::size_t solve_fours(const Rows& rows, std::size_t first) {
  return solve_wide<Direction, 4>(rows, first);
}
template <typename Direction>
__attribute__((target("avx512f,avx512dq,avx512vl"), flatten)) std::size_t solve_eights(const Rows& rows) {
  return solve_wide<Direction, 8>(rows, 0);
}

bool takes_four() { return __builtin_cpu_supports("avx2") != 0; }
bool takes_eight() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
}

// As many as the processor takes side by side; gives the first row that is left.
template <typename Direction>
std::size_t solve_side_by_side(const Rows& rows) {
  const std::size_t after_eights = takes_eight() ? solve_eights<Direction>(rows) : 0;
  return takes_four() ? solve_fours<Direction>(rows, after_eights) : after_eights;
}
#else
template <typename Direction>
std::size_t solve_side_by_side(const Rows& /*rows*/) {
  return 0;
}
#endif

template <typename Direction>
sms_status solve(const Rows& rows) {
  for (std::size_t i = solve_side_by_side<Direction>(rows); i < rows.n; ++i) {
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
