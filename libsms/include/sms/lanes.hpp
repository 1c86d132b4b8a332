// Four numbers side by side, as one scalar of the templates: four poses at a time, each with the bits that it has alone.
//
// One instruction of AVX2 does to four doubles what it does to one, and rounds as that does. A comparison gives an answer
// for each; templates ask all() or any() of it and take values by select() (scalar.hpp). For GCC and clang, on the desk;
// compiled without AVX2 it is as right, and no faster than one number at a time.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sms/forward_kinematics.hpp"
#include "sms/geometry.hpp"
#include "sms/newton.hpp"
#include "sms/rotation.hpp"

namespace sms {

// The arrays in the unions have numbers and conditions handed over in memory, so that code with AVX and without may call
// each other.
struct Lanes {
  static constexpr int count = 4;
  typedef double Numbers __attribute__((vector_size(32), aligned(8), may_alias));
  typedef long long Bits __attribute__((vector_size(32), aligned(8), may_alias));

  // A condition on each.
  struct Mask {
    union {
      long long of[4];  // all bits or none
      Bits all_of;
    };
    explicit Mask(const Bits& bits) : all_of(bits) {}
  };

  union {  // one by one and four at a time; GCC and clang allow to write one and read the other
    double at[4];
    Numbers all_at;
  };

  // A copy is one move of four numbers; left to the compiler it goes through memory in halves.
  Lanes() {}
  Lanes(const Lanes& b) : all_at(b.all_at) {}
  Lanes& operator=(const Lanes& b) {
    all_at = b.all_at;
    return *this;
  }
  Lanes(double each) : all_at{each, each, each, each} {}  // NOLINT(google-explicit-constructor): a constant
  explicit Lanes(const Numbers& numbers) : all_at(numbers) {}

  Lanes& operator+=(const Lanes& b) { return *this = Lanes(all_at + b.all_at); }
  Lanes& operator-=(const Lanes& b) { return *this = Lanes(all_at - b.all_at); }
  Lanes& operator*=(const Lanes& b) { return *this = Lanes(all_at * b.all_at); }
};

}  // namespace sms

namespace std {
template <>
struct numeric_limits<sms::Lanes> : numeric_limits<double> {};
}  // namespace std

namespace Eigen {
template <>
struct NumTraits<sms::Lanes> : NumTraits<double> {
  using Real = sms::Lanes;
  using NonInteger = sms::Lanes;
  using Nested = sms::Lanes;
  using Literal = sms::Lanes;
};
}  // namespace Eigen

namespace sms {

inline Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.all_at + b.all_at); }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.all_at - b.all_at); }
inline Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.all_at * b.all_at); }
inline Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.all_at / b.all_at); }
inline Lanes operator-(const Lanes& a) { return Lanes(-a.all_at); }

inline Lanes::Mask operator<(const Lanes& a, const Lanes& b) { return Lanes::Mask(a.all_at < b.all_at); }
inline Lanes::Mask operator>(const Lanes& a, const Lanes& b) { return Lanes::Mask(a.all_at > b.all_at); }
inline Lanes::Mask operator<=(const Lanes& a, const Lanes& b) { return Lanes::Mask(a.all_at <= b.all_at); }
inline Lanes::Mask operator>=(const Lanes& a, const Lanes& b) { return Lanes::Mask(a.all_at >= b.all_at); }
inline Lanes::Mask operator&&(const Lanes::Mask& a, const Lanes::Mask& b) { return Lanes::Mask(a.all_of & b.all_of); }
inline Lanes::Mask operator!(const Lanes::Mask& a) { return Lanes::Mask(~a.all_of); }
inline bool all(const Lanes::Mask& a) { return (a.of[0] & a.of[1] & a.of[2] & a.of[3]) != 0; }
inline bool any(const Lanes::Mask& a) { return (a.of[0] | a.of[1] | a.of[2] | a.of[3]) != 0; }

inline Lanes select(const Lanes::Mask& where, const Lanes& one, const Lanes& other) {
  return Lanes(where.all_of ? one.all_at : other.all_at);
}

inline Lanes abs(const Lanes& a) { return Lanes(a.all_at < 0.0 ? -a.all_at : a.all_at); }
inline Lanes sqrt(const Lanes& a) {
  Lanes root;
  for (int i = 0; i < Lanes::count; ++i) {
    root.at[i] = std::sqrt(a.at[i]);
  }
  return root;
}

template <int R, int C>
inline Eigen::Matrix<Lanes, R, C> select(const Lanes::Mask& where, const Eigen::Matrix<Lanes, R, C>& one,
                                         const Eigen::Matrix<Lanes, R, C>& other) {
  Eigen::Matrix<Lanes, R, C> chosen;
  for (int i = 0; i < R * C; ++i) {
    chosen(i % R, i / R) = select(where, one(i % R, i / R), other(i % R, i / R));
  }
  return chosen;
}

inline bool is_finite(const Lanes& s) { return all(s - s >= Lanes(0.0)); }

inline SineCosine<Lanes> sine_cosine(const Lanes& angle) { return double_series(angle); }

template <>
struct CountOf<Lanes> {
  using type = Lanes;
};

// Number by number: a struct that is copied as a whole goes through memory in halves.
inline void renew(const Lanes::Mask& where, Lanes& kept, const Lanes& fresh) { kept = select(where, fresh, kept); }
template <int R, int C>
inline void renew(const Lanes::Mask& where, Eigen::Matrix<Lanes, R, C>& kept, const Eigen::Matrix<Lanes, R, C>& fresh) {
  for (int i = 0; i < R * C; ++i) {
    renew(where, kept(i % R, i / R), fresh(i % R, i / R));
  }
}
inline void renew(const Lanes::Mask& where, Pose<Lanes>& kept, const Pose<Lanes>& fresh) {
  renew(where, kept.roll, fresh.roll);
  renew(where, kept.pitch, fresh.pitch);
  renew(where, kept.height, fresh.height);
  renew(where, kept.yaw, fresh.yaw);
  renew(where, kept.x, fresh.x);
  renew(where, kept.y, fresh.y);
}

template <>
struct NextSolver<Lanes> {
  PoseSolver<Lanes> solver;
  explicit NextSolver(const PoseSolver<Lanes>& /*last*/) {}
  void renew_where(const Lanes::Mask& moving, PoseSolver<Lanes>& last) const {
    renew(moving, last.panhard_inverse, solver.panhard_inverse);
    renew(moving, last.parasitic, solver.parasitic);
    renew(moving, last.actuator_parasitic, solver.actuator_parasitic);
    renew(moving, last.actuator_inverse, solver.actuator_inverse);
    renew(moving, last.yaw.sine, solver.yaw.sine);
    renew(moving, last.yaw.cosine, solver.yaw.cosine);
  }
};

// The same machine in every lane.
inline Geometry<Lanes> in_lanes(const Geometry<double>& g) {
  Geometry<Lanes> l;
  for (int i = 0; i < 6; ++i) {
    l.base[i] = g.base[i].cast<Lanes>();
    l.platform[i] = g.platform[i].cast<Lanes>();
    l.joint_axis[i] = g.joint_axis[i].cast<Lanes>();
  }
  l.reference = g.reference.cast<Lanes>();
  l.actuator_length = g.actuator_length.cast<Lanes>();
  l.panhard_length = g.panhard_length.cast<Lanes>();
  l.stroke = g.stroke;
  return l;
}

}  // namespace sms
