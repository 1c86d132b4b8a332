// How good a table is: against the solver, and on the way back to the angles.
#pragma once

#include <cstdint>

#include "grid.hpp"

namespace ik_tables {

struct Spread {
  double largest = 0.0;
  double square_sum = 0.0;
  long count = 0;

  void add(double error);
  double rms() const;
};

// One way to interpolate, at random points of the table.
struct Interpolation {
  Spread extension;    // against the solver, m
  Spread roll, pitch;  // after forward kinematics of the interpolated extensions, rad
  Spread height;       // m
  long lost = 0;       // points whose extensions no pose fits
  bool possible = false;

  double largest() const;  // error in m or rad, which weigh alike here: the joints are about 1 m from the middle
};

struct Verification {
  Spread nodes;  // stored extensions against a cold solve, m, at random nodes
  Interpolation linear, cubic;
};

// The lookups run in the table's precision, as a controller runs them; the solver and the way back in double. Cubic is
// possible with four nodes an axis or more.
Verification verify(const Table& table, const sms::Geometry<double>& geometry, int points, std::uint64_t seed,
                    Progress& progress);

}  // namespace ik_tables
