// Eigenvalues of a small symmetric matrix, by Jacobi's rotations: each turns one off-diagonal element to zero, and the
// sum of their squares shrinks faster than quadratically. Accurate to rounding, bounded, no heap.
#pragma once

#include <cmath>

#include "sms/scalar.hpp"

namespace sms {

template <typename S, int N>
struct SymmetricEigen {
  Eigen::Matrix<S, N, 1> values;   // ascending
  Eigen::Matrix<S, N, N> vectors;  // columns, orthonormal
};

// One rotation in the plane of rows p and q: a becomes R^T a R, v becomes v R.
template <typename S, int N>
void jacobi_rotation(Eigen::Matrix<S, N, N>& a, Eigen::Matrix<S, N, N>& v, int p, int q) {
  using std::abs;
  using std::sqrt;
  if (!(abs(a(p, q)) > S(0))) {
    return;
  }
  const S half = (a(q, q) - a(p, p)) / (S(2) * a(p, q));
  const S tangent = (half < S(0) ? S(-1) : S(1)) / (abs(half) + sqrt(half * half + S(1)));
  const S cosine = S(1) / sqrt(tangent * tangent + S(1)), sine = tangent * cosine;
  for (int k = 0; k < N; ++k) {
    const S kp = a(k, p), kq = a(k, q);
    a(k, p) = cosine * kp - sine * kq;
    a(k, q) = sine * kp + cosine * kq;
  }
  for (int k = 0; k < N; ++k) {
    const S pk = a(p, k), qk = a(q, k), kp = v(k, p), kq = v(k, q);
    a(p, k) = cosine * pk - sine * qk;
    a(q, k) = sine * pk + cosine * qk;
    v(k, p) = cosine * kp - sine * kq;
    v(k, q) = sine * kp + cosine * kq;
  }
}

template <typename S, int N>
SymmetricEigen<S, N> symmetric_eigen(Eigen::Matrix<S, N, N> a) {
  constexpr int kSweeps = 12;  // six are enough for N = 6 in double
  SymmetricEigen<S, N> e;
  e.vectors.setIdentity();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < N - 1; ++p) {
      for (int q = p + 1; q < N; ++q) {
        jacobi_rotation(a, e.vectors, p, q);
      }
    }
  }
  e.values = a.diagonal();
  for (int i = 0; i < N - 1; ++i) {  // selection sort: N is at most 6
    int least = i;
    for (int k = i + 1; k < N; ++k) {
      least = e.values(k) < e.values(least) ? k : least;
    }
    std::swap(e.values(i), e.values(least));
    for (int k = 0; k < N; ++k) {
      std::swap(e.vectors(k, i), e.vectors(k, least));
    }
  }
  return e;
}

// Largest over smallest singular value.
template <typename S, int N>
S condition_number(const Eigen::Matrix<S, N, N>& m) {
  using std::sqrt;
  const Eigen::Matrix<S, N, 1> squares = symmetric_eigen<S, N>(m.transpose() * m).values;
  return sqrt(squares(N - 1) / squares(0));
}

}  // namespace sms
