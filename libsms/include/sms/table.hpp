// A table of extensions in place of the solver (dissertation, section 3.5): lookup and interpolation.
//
// Somebody solved the inverse kinematics beforehand, at evenly spaced nodes of roll and pitch, for one height or for
// several; ik_tables does that. Between the nodes, coordinate by coordinate, with t in 0..1 the place within a cell:
//
//   linear:  (1 - t) f_0 + t f_1                                error about h^2 f'' / 8
//   cubic:   the Catmull-Rom spline, which is cubic convolution with a = -1/2 (R. Keys, IEEE Trans. Acoustics, Speech
//            and Signal Processing 29, 1981); its first derivative is continuous;  error about h^3 f'''
//
// The spline needs a node on both sides of the cell. Beyond the edge of the table Keys continues f by the parabola
// through the last three nodes, f_-1 = 3 f_0 - 3 f_1 + f_2, so that a quadratic is reproduced everywhere. That goes
// into the weights here, and no node outside is read.
//
// A lookup does the same work wherever it falls, but for a branch at the edges; it allocates nothing, calls nothing and
// never extrapolates. The numbers stay where the caller has them: in flash. For float and double.
#pragma once

#include "sms/scalar.hpp"
#include "sms/sms.h"

namespace sms {

// Evenly spaced nodes of one coordinate.
template <typename S>
struct TableAxis {
  int count;          // of nodes
  S lower;            // the first node, rad or m
  S upper;            // the last node
  S reciprocal_step;  // (count - 1) / (upper - lower); 0 for a single node
};

template <typename S>
struct Table {
  TableAxis<S> roll;
  TableAxis<S> pitch;
  TableAxis<S> height;  // a single node: a table at one height
  const S* extension;   // m, [roll][pitch][height][actuator], the last index next to each other
};

// The nodes that a value is made of along one coordinate, and what each counts.
template <typename S, int N>
struct Stencil {
  int first;
  S weight[N];
};

template <typename S>
void weigh(int cell, int /*count*/, const S& t, Stencil<S, 2>& stencil) {
  stencil = {cell, {S(1) - t, t}};
}

template <typename S>
void weigh(int cell, int count, const S& t, Stencil<S, 4>& stencil) {
  const S before = S(0.5) * t * (t * (S(2) - t) - S(1));
  const S left = S(0.5) * t * t * (S(3) * t - S(5)) + S(1);
  const S right = S(0.5) * t * (t * (S(4) - S(3) * t) + S(1));
  const S after = S(0.5) * t * t * (t - S(1));
  if (cell == 0) {
    stencil = {0, {left + S(3) * before, right - S(3) * before, after + before, S(0)}};
  } else if (cell == count - 2) {
    stencil = {count - 4, {S(0), before + after, left - S(3) * after, right + S(3) * after}};
  } else {
    stencil = {cell - 1, {before, left, right, after}};
  }
}

// Can a stencil of that many nodes be put at the value?
template <typename S>
sms_status within(const TableAxis<S>& axis, const S& value, int nodes) {
  if (!is_finite(value)) {
    return SMS_NOT_A_NUMBER;
  }
  return value < axis.lower || value > axis.upper || axis.count < nodes ? SMS_OUT_OF_RANGE : SMS_OK;
}

// The stencil of N nodes (2: linear, 4: cubic) at a value that is within the axis.
template <int N, typename S>
Stencil<S, N> stencil_at(const TableAxis<S>& axis, const S& value) {
  const S along = (value - axis.lower) * axis.reciprocal_step;
  const int whole = int(along), last = axis.count - 2;
  const int cell = whole < last ? whole : last;
  Stencil<S, N> stencil;
  weigh(cell, axis.count, along - S(cell), stencil);
  return stencil;
}

inline sms_status first_failure(sms_status a, sms_status b) { return a != SMS_OK ? a : b; }

// The weighted sum of the nodes under three stencils.
template <typename S, int N, int H>
Vec3<S> blend(const Table<S>& table, const Stencil<S, N>& roll, const Stencil<S, N>& pitch,
              const Stencil<S, H>& height) {
  // long: 121,203 numbers, and int has 16 bits on some controllers
  const long per_pitch = 3 * long(table.height.count), per_roll = per_pitch * table.pitch.count;
  const S* corner = table.extension + roll.first * per_roll + pitch.first * per_pitch + 3 * long(height.first);
  Vec3<S> sum(S(0), S(0), S(0));
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < N; ++k) {
      const S* node = corner + i * per_roll + k * per_pitch;
      for (int l = 0; l < H; ++l, node += 3) {
        sum += (roll.weight[i] * pitch.weight[k] * height.weight[l]) * Vec3<S>(node[0], node[1], node[2]);
      }
    }
  }
  return sum;
}

template <int N, typename S>
sms_status look_up(const Table<S>& table, const S& roll, const S& pitch, Vec3<S>& extension) {
  const sms_status status = first_failure(within(table.roll, roll, N), within(table.pitch, pitch, N));
  if (status != SMS_OK) {
    return status;
  }
  if (table.height.count != 1) {
    return SMS_OUT_OF_RANGE;
  }
  const Stencil<S, 1> only = {0, {S(1)}};
  extension = blend(table, stencil_at<N>(table.roll, roll), stencil_at<N>(table.pitch, pitch), only);
  return SMS_OK;
}

template <int N, typename S>
sms_status look_up(const Table<S>& table, const S& roll, const S& pitch, const S& height, Vec3<S>& extension) {
  const sms_status level = first_failure(within(table.roll, roll, N), within(table.pitch, pitch, N));
  const sms_status status = first_failure(level, within(table.height, height, N));
  if (status != SMS_OK) {
    return status;
  }
  extension = blend(table, stencil_at<N>(table.roll, roll), stencil_at<N>(table.pitch, pitch),
                    stencil_at<N>(table.height, height));
  return SMS_OK;
}

// Extensions at (roll, pitch) from a table at one height. SMS_NOT_A_NUMBER, or SMS_OUT_OF_RANGE outside the table, for
// a table of several heights, and for cubic with fewer than four nodes on an axis; the extensions then are as they
// were.
template <typename S>
sms_status table_bilinear(const Table<S>& table, const S& roll, const S& pitch, Vec3<S>& extension) {
  return look_up<2>(table, roll, pitch, extension);
}

template <typename S>
sms_status table_bicubic(const Table<S>& table, const S& roll, const S& pitch, Vec3<S>& extension) {
  return look_up<4>(table, roll, pitch, extension);
}

// Extensions at (roll, pitch, height) from a table of several heights, by the same rules.
template <typename S>
sms_status table_trilinear(const Table<S>& table, const S& roll, const S& pitch, const S& height, Vec3<S>& extension) {
  return look_up<2>(table, roll, pitch, height, extension);
}

template <typename S>
sms_status table_tricubic(const Table<S>& table, const S& roll, const S& pitch, const S& height, Vec3<S>& extension) {
  return look_up<4>(table, roll, pitch, height, extension);
}

}  // namespace sms
