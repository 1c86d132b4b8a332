// Four or eight numbers side by side, as one scalar of the templates: as many poses at a time, each with the bits that it
// has alone.
//
// One instruction of AVX2 does to four doubles what it does to one, and one of AVX-512 to eight, and rounds as that does. A
// comparison gives an answer for each; templates ask all() or any() of it and take values by select() (scalar.hpp). For
// GCC and clang, on the desk; compiled without these instructions it is as right, and no faster than one number at a time.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sms/forward_kinematics.hpp"
#include "sms/geometry.hpp"
#include "sms/newton.hpp"
#include "sms/rotation.hpp"

namespace sms {

// What one instruction takes.
template <int N>
struct Wide;
template <>
struct Wide<4> {
  typedef double Numbers __attribute__((vector_size(32), aligned(8), may_alias));
  typedef long long Bits __attribute__((vector_size(32), aligned(8), may_alias));
};
template <>
struct Wide<8> {
  typedef double Numbers __attribute__((vector_size(64), aligned(8), may_alias));
  typedef long long Bits __attribute__((vector_size(64), aligned(8), may_alias));
};

// The arrays in the unions have numbers and conditions handed over in memory, so that code with wide instructions and
// without may call each other.
template <int N>
struct Lanes {
  static constexpr int count = N;
  using Numbers = typename Wide<N>::Numbers;
  using Bits = typename Wide<N>::Bits;

  // A condition on each.
  struct Mask {
    union {
      long long of[N];  // all bits or none
      Bits all_of;
    };
    explicit Mask(const Bits& bits) : all_of(bits) {}
  };

  union {  // one by one and all at a time; GCC and clang allow to write one and read the other
    double at[N];
    Numbers all_at;
  };

  // A copy is one move of all numbers; left to the compiler it goes through memory in halves.
  Lanes() {}
  Lanes(const Lanes& b) : all_at(b.all_at) {}
  Lanes& operator=(const Lanes& b) {
    all_at = b.all_at;
    return *this;
  }
  Lanes(double each) : all_at(each - Numbers{}) {}  // NOLINT(google-explicit-constructor): a constant
  explicit Lanes(const Numbers& numbers) : all_at(numbers) {}

  Lanes& operator+=(const Lanes& b) { return *this = Lanes(all_at + b.all_at); }
  Lanes& operator-=(const Lanes& b) { return *this = Lanes(all_at - b.all_at); }
  Lanes& operator*=(const Lanes& b) { return *this = Lanes(all_at * b.all_at); }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.all_at + b.all_at); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.all_at - b.all_at); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.all_at * b.all_at); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.all_at / b.all_at); }
  friend Lanes operator-(const Lanes& a) { return Lanes(-a.all_at); }

  friend Mask operator<(const Lanes& a, const Lanes& b) { return Mask(a.all_at < b.all_at); }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return Mask(a.all_at > b.all_at); }
  friend Mask operator<=(const Lanes& a, const Lanes& b) { return Mask(a.all_at <= b.all_at); }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return Mask(a.all_at >= b.all_at); }
  friend Mask operator&&(const Mask& a, const Mask& b) { return Mask(a.all_of & b.all_of); }
  friend Mask operator!(const Mask& a) { return Mask(~a.all_of); }
  friend bool all(const Mask& a) {
    long long every = -1;
    for (int i = 0; i < N; ++i) {
      every &= a.of[i];
    }
    return every != 0;
  }
  friend bool any(const Mask& a) {
    long long some = 0;
    for (int i = 0; i < N; ++i) {
      some |= a.of[i];
    }
    return some != 0;
  }

  friend Lanes select(const Mask& where, const Lanes& one, const Lanes& other) {
    return Lanes(where.all_of ? one.all_at : other.all_at);
  }

  friend Lanes abs(const Lanes& a) { return Lanes(a.all_at < 0.0 ? -a.all_at : a.all_at); }
  friend Lanes sqrt(const Lanes& a) {
    Lanes root;
    for (int i = 0; i < N; ++i) {
      root.at[i] = std::sqrt(a.at[i]);
    }
    return root;
  }
  friend bool is_finite(const Lanes& s) { return all(s - s >= Lanes(0.0)); }
  friend SineCosine<Lanes> sine_cosine(const Lanes& angle) { return double_series(angle); }

  // Number by number: a struct that is copied as a whole goes through memory in halves.
  friend void renew(const Mask& where, Lanes& kept, const Lanes& fresh) { kept = select(where, fresh, kept); }
};

}  // namespace sms

namespace std {
template <int N>
struct numeric_limits<sms::Lanes<N>> : numeric_limits<double> {};
}  // namespace std

namespace Eigen {
template <int N>
struct NumTraits<sms::Lanes<N>> : NumTraits<double> {
  using Real = sms::Lanes<N>;
  using NonInteger = sms::Lanes<N>;
  using Nested = sms::Lanes<N>;
  using Literal = sms::Lanes<N>;
};
}  // namespace Eigen

namespace sms {

template <int N>
struct CountOf<Lanes<N>> {
  using type = Lanes<N>;
};

template <int N, int R, int C>
Eigen::Matrix<Lanes<N>, R, C> select(const typename Lanes<N>::Mask& where, const Eigen::Matrix<Lanes<N>, R, C>& one,
                                     const Eigen::Matrix<Lanes<N>, R, C>& other) {
  Eigen::Matrix<Lanes<N>, R, C> chosen;
  for (int i = 0; i < R * C; ++i) {
    chosen(i % R, i / R) = select(where, one(i % R, i / R), other(i % R, i / R));
  }
  return chosen;
}

template <int N, int R, int C>
void renew(const typename Lanes<N>::Mask& where, Eigen::Matrix<Lanes<N>, R, C>& kept,
           const Eigen::Matrix<Lanes<N>, R, C>& fresh) {
  for (int i = 0; i < R * C; ++i) {
    renew(where, kept(i % R, i / R), fresh(i % R, i / R));
  }
}

template <int N>
void renew(const typename Lanes<N>::Mask& where, Pose<Lanes<N>>& kept, const Pose<Lanes<N>>& fresh) {
  renew(where, kept.roll, fresh.roll);
  renew(where, kept.pitch, fresh.pitch);
  renew(where, kept.height, fresh.height);
  renew(where, kept.yaw, fresh.yaw);
  renew(where, kept.x, fresh.x);
  renew(where, kept.y, fresh.y);
}

template <int N>
struct NextSolver<Lanes<N>> {
  PoseSolver<Lanes<N>> solver;
  explicit NextSolver(const PoseSolver<Lanes<N>>& /*last*/) {}
  void renew_where(const typename Lanes<N>::Mask& moving, PoseSolver<Lanes<N>>& last) const {
    renew(moving, last.panhard_inverse, solver.panhard_inverse);
    renew(moving, last.parasitic, solver.parasitic);
    renew(moving, last.actuator_parasitic, solver.actuator_parasitic);
    renew(moving, last.actuator_inverse, solver.actuator_inverse);
    renew(moving, last.yaw.sine, solver.yaw.sine);
    renew(moving, last.yaw.cosine, solver.yaw.cosine);
  }
};

// The same machine in every lane.
template <int N>
Geometry<Lanes<N>> in_lanes(const Geometry<double>& g) {
  using L = Lanes<N>;
  Geometry<L> l;
  for (int i = 0; i < 6; ++i) {
    l.base[i] = g.base[i].cast<L>();
    l.platform[i] = g.platform[i].cast<L>();
    l.joint_axis[i] = g.joint_axis[i].cast<L>();
  }
  l.reference = g.reference.cast<L>();
  l.actuator_length = g.actuator_length.cast<L>();
  l.panhard_length = g.panhard_length.cast<L>();
  l.stroke = g.stroke;
  return l;
}

}  // namespace sms
