// A number with its derivatives in N directions: a + v e, with e e = 0.
//
// ceres::Jet by another name, to the last bit, for what is compiled a hundred times over: an operation here is one
// statement of the compiler's own vectors, where there it is an expression that a compiler first has to take apart. What
// is held against records compiles in half of the time so. Four directions fill an AVX register; N is a multiple of 4.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "sms/effect.hpp"

namespace sms {
namespace estimation {

template <int N>
struct Jet {
  static_assert(N > 0 && N % 4 == 0, "whole registers");
  static constexpr int DIMENSION = N;
  typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));

  double a;
  union {  // the derivatives, one by one and four at a time; GCC and clang allow to write one and read the other
    double v[N];
    Four w[N / 4];
  };

  Jet() = default;
  Jet(double value) : a(value) {  // NOLINT(google-explicit-constructor): a constant is a number
    for (int k = 0; k < N / 4; ++k) {
      four(k) = Four{0.0, 0.0, 0.0, 0.0};
    }
  }
  // Number `direction` of the independent ones.
  Jet(double value, int direction) : Jet(value) { v[direction] = 1.0; }

  Four& four(int k) { return w[k]; }
  const Four& four(int k) const { return w[k]; }

  Jet& operator+=(const Jet& g) { return *this = *this + g; }
  Jet& operator-=(const Jet& g) { return *this = *this - g; }
  Jet& operator*=(const Jet& g) { return *this = *this * g; }
  Jet& operator/=(const Jet& g) { return *this = *this / g; }
};

namespace detail {

// A function of one number: its value and its derivative at f.
template <int N>
inline Jet<N> chain(double value, double slope, const Jet<N>& f) {
  Jet<N> r;
  r.a = value;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = slope * f.four(k);
  }
  return r;
}

// A function of two.
template <int N>
inline Jet<N> chain(double value, double f_slope, const Jet<N>& f, double g_slope, const Jet<N>& g) {
  Jet<N> r;
  r.a = value;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = f_slope * f.four(k) + g_slope * g.four(k);
  }
  return r;
}

}  // namespace detail

// ---- arithmetic ----

template <int N>
inline Jet<N> operator+(const Jet<N>& f, const Jet<N>& g) {
  Jet<N> r;
  r.a = f.a + g.a;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = f.four(k) + g.four(k);
  }
  return r;
}
template <int N>
inline Jet<N> operator-(const Jet<N>& f, const Jet<N>& g) {
  Jet<N> r;
  r.a = f.a - g.a;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = f.four(k) - g.four(k);
  }
  return r;
}
template <int N>
inline Jet<N> operator-(const Jet<N>& f) {
  Jet<N> r;
  r.a = -f.a;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = -f.four(k);
  }
  return r;
}
template <int N>
inline Jet<N> operator*(const Jet<N>& f, const Jet<N>& g) {
  Jet<N> r;
  r.a = f.a * g.a;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = f.a * g.four(k) + f.four(k) * g.a;
  }
  return r;
}
template <int N>
inline Jet<N> operator/(const Jet<N>& f, const Jet<N>& g) {
  const double inverse = 1.0 / g.a, ratio = f.a * inverse;
  Jet<N> r;
  r.a = ratio;
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = (f.four(k) - ratio * g.four(k)) * inverse;
  }
  return r;
}

template <int N>
inline Jet<N> operator+(const Jet<N>& f, double s) {
  Jet<N> r = f;
  r.a += s;
  return r;
}
template <int N>
inline Jet<N> operator+(double s, const Jet<N>& f) {
  return f + s;
}
template <int N>
inline Jet<N> operator-(const Jet<N>& f, double s) {
  Jet<N> r = f;
  r.a -= s;
  return r;
}
template <int N>
inline Jet<N> operator-(double s, const Jet<N>& f) {
  Jet<N> r = -f;
  r.a = s - f.a;
  return r;
}
template <int N>
inline Jet<N> operator*(const Jet<N>& f, double s) {
  return detail::chain(f.a * s, s, f);
}
template <int N>
inline Jet<N> operator*(double s, const Jet<N>& f) {
  return f * s;
}
template <int N>
inline Jet<N> operator/(const Jet<N>& f, double s) {
  return f * (1.0 / s);
}
template <int N>
inline Jet<N> operator/(double s, const Jet<N>& g) {
  return detail::chain(s / g.a, -s / (g.a * g.a), g);
}

// Compared by value.
#define SMS_JET_COMPARES(op)                                  \
  template <int N>                                            \
  inline bool operator op(const Jet<N>& f, const Jet<N>& g) { \
    return f.a op g.a;                                        \
  }                                                           \
  template <int N>                                            \
  inline bool operator op(const Jet<N>& f, double s) {        \
    return f.a op s;                                          \
  }                                                           \
  template <int N>                                            \
  inline bool operator op(double s, const Jet<N>& f) {        \
    return s op f.a;                                          \
  }
SMS_JET_COMPARES(<)
SMS_JET_COMPARES(<=)
SMS_JET_COMPARES(>)
SMS_JET_COMPARES(>=)
#undef SMS_JET_COMPARES

using sms::is_absent;

// Of a parameter whose effect is switched off, and against which nobody asks for a derivative (effect.hpp).
template <int N>
inline bool is_absent(const Jet<N>& f) {
  typename Jet<N>::Four squares = f.four(0) * f.four(0);
  for (int k = 1; k < N / 4; ++k) {
    squares += f.four(k) * f.four(k);
  }
  return sms::is_absent(f.a) && sms::is_absent((squares[0] + squares[1]) + (squares[2] + squares[3]));
}

// ---- functions ----

template <int N>
inline Jet<N> abs(const Jet<N>& f) {
  return detail::chain(std::abs(f.a), std::copysign(1.0, f.a), f);
}
template <int N>
inline Jet<N> sqrt(const Jet<N>& f) {
  const double root = std::sqrt(f.a);
  return detail::chain(root, 1.0 / (2.0 * root), f);
}
template <int N>
inline Jet<N> exp(const Jet<N>& f) {
  const double value = std::exp(f.a);
  return detail::chain(value, value, f);
}
template <int N>
inline Jet<N> sin(const Jet<N>& f) {
  return detail::chain(std::sin(f.a), std::cos(f.a), f);
}
template <int N>
inline Jet<N> cos(const Jet<N>& f) {
  return detail::chain(std::cos(f.a), -std::sin(f.a), f);
}
template <int N>
inline Jet<N> atan(const Jet<N>& f) {
  return detail::chain(std::atan(f.a), 1.0 / (1.0 + f.a * f.a), f);
}
template <int N>
inline Jet<N> atan2(const Jet<N>& g, const Jet<N>& f) {
  const double scale = 1.0 / (f.a * f.a + g.a * g.a);
  Jet<N> r;
  r.a = std::atan2(g.a, f.a);
  for (int k = 0; k < N / 4; ++k) {
    r.four(k) = scale * (-g.a * f.four(k) + f.a * g.four(k));
  }
  return r;
}
template <int N>
inline Jet<N> floor(const Jet<N>& f) {
  return std::floor(f.a);
}
template <int N>
inline Jet<N> ceil(const Jet<N>& f) {
  return std::ceil(f.a);
}

// With the limits at a base of zero; a base below zero has no derivative against its exponent.
template <int N>
Jet<N> pow(const Jet<N>& f, const Jet<N>& g) {
  if (std::fpclassify(f.a) == FP_ZERO && g.a >= 1.0) {
    return g.a > 1.0 ? Jet<N>(0.0) : f;
  }
  const double value = std::pow(f.a, g.a);
  const double slope = f.a > 0.0 ? g.a * (value / f.a) : g.a * std::pow(f.a, g.a - 1.0);
  if (f.a < 0.0 && g.a >= std::floor(g.a) && g.a <= std::floor(g.a)) {
    Jet<N> result = detail::chain(value, slope, f);
    for (int k = 0; k < N; ++k) {
      result.v[k] = std::fpclassify(g.v[k]) == FP_ZERO ? result.v[k] : std::numeric_limits<double>::quiet_NaN();
    }
    return result;
  }
  return detail::chain(value, slope, f, value * std::log(f.a), g);
}

}  // namespace estimation
}  // namespace sms

// ---- what a vector of them asks ----

template <int N>
struct std::numeric_limits<sms::estimation::Jet<N>> : std::numeric_limits<double> {};

template <int N>
struct Eigen::NumTraits<sms::estimation::Jet<N>> : Eigen::GenericNumTraits<sms::estimation::Jet<N>> {
  using Real = sms::estimation::Jet<N>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 3,
    RequireInitialization = 1
  };
  static Real epsilon() { return std::numeric_limits<double>::epsilon(); }
  static Real dummy_precision() { return 1e-12; }
  static int digits10() { return std::numeric_limits<double>::digits10; }
  static Real highest() { return std::numeric_limits<double>::max(); }
  static Real lowest() { return std::numeric_limits<double>::lowest(); }
};

template <typename Operation, int N>
struct Eigen::ScalarBinaryOpTraits<sms::estimation::Jet<N>, double, Operation> {
  using ReturnType = sms::estimation::Jet<N>;
};
template <typename Operation, int N>
struct Eigen::ScalarBinaryOpTraits<double, sms::estimation::Jet<N>, Operation> {
  using ReturnType = sms::estimation::Jet<N>;
};
