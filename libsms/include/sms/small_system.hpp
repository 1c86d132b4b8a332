// Six linear equations by Gaussian elimination with partial pivoting: for matrices that may come close to singular,
// which the closed forms of scalar.hpp are not made for. Fixed size, no heap; the determinant falls out.
#pragma once

#include <cmath>
#include <limits>

#include "sms/scalar.hpp"

namespace sms {

template <typename S>
using Vec6 = Eigen::Matrix<S, 6, 1>;
template <typename S>
using Mat6 = Eigen::Matrix<S, 6, 6>;

// P A = L U; L below the diagonal (its own is 1), U on and above it.
template <typename V>
struct Factors {
  Mat6<V> lu;
  int row[6];            // of A, that stands in row i
  V reciprocal[6];       // of U's diagonal
  V determinant;         // of A
  V smallest_of_pivots;  // smallest over largest pivot; 0 where a pivot is 0: a cheap sign of a singular matrix
};

template <typename V>
void factorize(const Mat6<V>& a, Factors<V>& f) {
  using std::abs;
  f.lu = a;
  f.determinant = V(1);
  V smallest = std::numeric_limits<V>::max(), largest = V(0);
  for (int i = 0; i < 6; ++i) {
    f.row[i] = i;
  }
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i) {
      pivot = abs(f.lu(i, k)) > abs(f.lu(pivot, k)) ? i : pivot;
    }
    if (pivot != k) {
      f.lu.row(k).swap(f.lu.row(pivot));
      std::swap(f.row[k], f.row[pivot]);
      f.determinant = -f.determinant;
    }
    const V diagonal = f.lu(k, k), size = abs(diagonal);
    f.determinant *= diagonal;
    smallest = size < smallest ? size : smallest;
    largest = size > largest ? size : largest;
    f.reciprocal[k] = size > V(0) ? V(1) / diagonal : V(0);
    for (int i = k + 1; i < 6; ++i) {
      const V factor = f.lu(i, k) * f.reciprocal[k];
      f.lu(i, k) = factor;
      for (int j = k + 1; j < 6; ++j) {
        f.lu(i, j) -= factor * f.lu(k, j);
      }
    }
  }
  f.smallest_of_pivots = largest > V(0) ? smallest / largest : V(0);
}

// To rounding, no inverse exists.
template <typename V>
bool is_singular(const Factors<V>& f) {
  return !(f.smallest_of_pivots > V(16) * std::numeric_limits<V>::epsilon());
}

// x of A x = right.
template <typename S, typename V>
Vec6<S> solution(const Factors<V>& f, const Vec6<S>& right) {
  Vec6<S> x;
  for (int i = 0; i < 6; ++i) {
    x(i) = right(f.row[i]);
    for (int j = 0; j < i; ++j) {
      x(i) -= S(f.lu(i, j)) * x(j);
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int j = i + 1; j < 6; ++j) {
      x(i) -= S(f.lu(i, j)) * x(j);
    }
    x(i) *= S(f.reciprocal[i]);
  }
  return x;
}

}  // namespace sms
