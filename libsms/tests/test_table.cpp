// Lookup in a table: exact at the nodes and on what the interpolation can represent, and of the order it claims
// between.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mechanism_cases.hpp"
#include "sms/table.hpp"

using namespace sms_test;

namespace {

const sms::Geometry<double> geometry = sms::make_geometry(sms::Params<double>());

template <typename S>
sms::TableAxis<S> axis(int count, double lower, double upper) {
  return {count, S(lower), S(upper), count == 1 ? S(0) : S((count - 1) / (upper - lower))};
}

template <typename S>
S node_of(const sms::TableAxis<S>& a, int i) {
  return i == a.count - 1 ? a.upper : a.lower + (a.upper - a.lower) * S(i) / S(a.count - 1);
}

// A table that owns its numbers; f(q) gives the three of a node.
template <typename S>
struct OwningTable {
  sms::Table<S> table;
  std::vector<S> numbers;

  template <typename F>
  OwningTable(sms::TableAxis<S> roll, sms::TableAxis<S> pitch, sms::TableAxis<S> height, const F& f) {
    for (int i = 0; i < roll.count; ++i) {
      for (int k = 0; k < pitch.count; ++k) {
        for (int l = 0; l < height.count; ++l) {
          const Vec node = f(Vec(double(node_of(roll, i)), double(node_of(pitch, k)), double(node_of(height, l))));
          for (int actuator = 0; actuator < 3; ++actuator) numbers.push_back(S(node(actuator)));
        }
      }
    }
    table = {roll, pitch, height, numbers.data()};
  }
};

template <typename F>
OwningTable<double> mechanism_table(int count, double angle, const F& f) {
  return {axis<double>(count, -angle, angle), axis<double>(count, -angle, angle), axis<double>(1, 0.5, 0.5), f};
}

Vec solved(const Vec& q) { return extension_at(geometry, q); }

// Three different polynomials of a degree in each of the coordinates, with coefficients of order 1.
struct Polynomials {
  int degree;
  std::vector<double> coefficient;

  Polynomials(int degree_, Random& random) : degree(degree_) {
    for (int i = 0; i < 3 * (degree + 1) * (degree + 1) * (degree + 1); ++i) {
      coefficient.push_back(random.uniform(-1.0, 1.0));
    }
  }
  Vec operator()(const Vec& q) const {
    Vec sum = Vec::Zero();
    const double* c = coefficient.data();
    double x = 1.0;
    for (int i = 0; i <= degree; ++i, x *= q(0)) {
      double y = 1.0;
      for (int k = 0; k <= degree; ++k, y *= q(1)) {
        double z = 1.0;
        for (int l = 0; l <= degree; ++l, z *= q(2), c += 3) sum += x * y * z * Vec(c[0], c[1], c[2]);
      }
    }
    return sum;
  }
};

int random_count(Random& random) { return int(random.uniform(4.0, 9.0)); }

template <typename S>
sms::TableAxis<S> random_axis(Random& random) {
  const double lower = random.uniform(-1.0, 0.5);
  return axis<S>(random_count(random), lower, lower + random.uniform(0.1, 0.5));
}

Vec random_place(Random& random, const sms::Table<double>& t) {
  const auto along = [&random](const sms::TableAxis<double>& a) { return random.uniform(a.lower, a.upper); };
  return {along(t.roll), along(t.pitch), along(t.height)};
}

// Largest error of a lookup against the solver, m, at random places.
template <typename Lookup>
double error_of(const Lookup& lookup, const OwningTable<double>& t, Random& random) {
  double error = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Vec q(random.uniform(t.table.roll.lower, t.table.roll.upper),
                random.uniform(t.table.pitch.lower, t.table.pitch.upper), 0.5);
    Vec found;
    REQUIRE(lookup(t.table, q(0), q(1), found) == sms_status::SMS_OK);
    error = std::max(error, largest(found - solved(q)));
  }
  return error;
}

// By how much of a cell a lookup at a node may miss it. The node, v, and both ends of the axis are rounded by half an
// epsilon of their magnitude, and so is the step's reciprocal by that of its own ends: three halves over the range. What
// remains, (v - lower) times the reciprocal, is rounded in proportion.
template <typename S>
double missed_cells(const sms::TableAxis<S>& a) {
  if (a.count == 1) return 0.0;
  const double range = double(a.upper) - double(a.lower);
  const double magnitude = std::max(std::abs(double(a.lower)), std::abs(double(a.upper)));
  return double(std::numeric_limits<S>::epsilon()) * (a.count - 1) * (1.5 * magnitude / range + 3.0);
}

template <typename S>
void check_nodes(Random& random) {
  const auto noise = [&random](const Vec&) { return random_vector(random, -1.0, 1.0); };
  const OwningTable<S> flat(random_axis<S>(random), random_axis<S>(random), axis<S>(1, 0.5, 0.5), noise);
  const OwningTable<S> deep(random_axis<S>(random), random_axis<S>(random), random_axis<S>(random), noise);
  for (const OwningTable<S>* t : {&flat, &deep}) {
    const sms::Table<S>& table = t->table;
    // Between nodes within +-1 no interpolation is steeper than the parabola at an edge: (3 + 4 + 1) / 2 a cell.
    const double missed = missed_cells(table.roll) + missed_cells(table.pitch) + missed_cells(table.height);
    const double rounding = 4.0 * missed + 30.0 * double(std::numeric_limits<S>::epsilon());
    const S* number = t->numbers.data();
    for (int i = 0; i < table.roll.count; ++i) {
      for (int k = 0; k < table.pitch.count; ++k) {
        for (int l = 0; l < table.height.count; ++l, number += 3) {
          const S roll = node_of(table.roll, i), pitch = node_of(table.pitch, k), height = node_of(table.height, l);
          sms::Vec3<S> linear, cubic;
          if (t == &flat) {
            REQUIRE(sms::table_bilinear(table, roll, pitch, linear) == sms_status::SMS_OK);
            REQUIRE(sms::table_bicubic(table, roll, pitch, cubic) == sms_status::SMS_OK);
          } else {
            REQUIRE(sms::table_trilinear(table, roll, pitch, height, linear) == sms_status::SMS_OK);
            REQUIRE(sms::table_tricubic(table, roll, pitch, height, cubic) == sms_status::SMS_OK);
          }
          for (int actuator = 0; actuator < 3; ++actuator) {
            CHECK(std::abs(double(linear(actuator) - number[actuator])) < rounding);
            CHECK(std::abs(double(cubic(actuator) - number[actuator])) < rounding);
          }
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("a lookup at a node gives the node, in both precisions") {
  Random random;
  for (int i = 0; i < 20; ++i) {
    check_nodes<double>(random);
    check_nodes<float>(random);
  }
}

TEST_CASE("linear reproduces what is linear in each coordinate, cubic what is quadratic: edges included") {
  Random random;
  for (int i = 0; i < sms_test::count / 50; ++i) {
    const Polynomials ramp(1, random), parabola(2, random);
    const sms::TableAxis<double> roll = random_axis<double>(random), pitch = random_axis<double>(random);
    const sms::TableAxis<double> height = random_axis<double>(random), single = axis<double>(1, 0.3, 0.3);
    const OwningTable<double> ramps(roll, pitch, height, ramp), parabolas(roll, pitch, height, parabola);
    const OwningTable<double> flat_ramps(roll, pitch, single, ramp), flat_parabolas(roll, pitch, single, parabola);
    for (int k = 0; k < 50; ++k) {
      const Vec q = random_place(random, ramps.table), flat(q(0), q(1), 0.3);
      Vec found;
      CHECK(sms::table_trilinear(ramps.table, q(0), q(1), q(2), found) == sms_status::SMS_OK);
      CHECK(largest(found - ramp(q)) < 1e-13);
      CHECK(sms::table_tricubic(parabolas.table, q(0), q(1), q(2), found) == sms_status::SMS_OK);
      CHECK(largest(found - parabola(q)) < 1e-12);
      CHECK(sms::table_bilinear(flat_ramps.table, q(0), q(1), found) == sms_status::SMS_OK);
      CHECK(largest(found - ramp(flat)) < 1e-13);
      CHECK(sms::table_bicubic(flat_parabolas.table, q(0), q(1), found) == sms_status::SMS_OK);
      CHECK(largest(found - parabola(flat)) < 1e-12);
    }
  }
}

TEST_CASE("order of the error on the mechanism: second for linear, third or better for cubic") {
  Random random;
  const OwningTable<double> coarse = mechanism_table(11, 0.1, solved), fine = mechanism_table(21, 0.1, solved);
  const double linear = error_of(sms::table_bilinear<double>, coarse, random);
  const double linear_fine = error_of(sms::table_bilinear<double>, fine, random);
  CHECK(linear / linear_fine == doctest::Approx(4.0).epsilon(0.15));
  const double cubic = error_of(sms::table_bicubic<double>, coarse, random);
  const double cubic_fine = error_of(sms::table_bicubic<double>, fine, random);
  CHECK(cubic / cubic_fine > 6.5);
  CHECK(cubic < 0.1 * linear);
}

TEST_CASE("the table of section 3.5 interpolates to 7.3e-8 m at best") {
  // Around the corner of the table, where the error is largest.
  Random random;
  const OwningTable<double> corner(axis<double>(21, -0.1, -0.08), axis<double>(21, 0.08, 0.1),
                                   axis<double>(1, 0.5, 0.5), solved);
  const double error = error_of(sms::table_bilinear<double>, corner, random);
  CHECK(error > 4e-8);
  CHECK(error < 7.5e-8);
}

TEST_CASE("the spline has a continuous slope") {
  Random random;
  const auto noise = [&random](const Vec&) { return random_vector(random, -1.0, 1.0); };
  const OwningTable<double> t = mechanism_table(7, 0.3, noise);
  for (int i = 1; i < 6; ++i) {
    const double node = -0.3 + 0.1 * i, step = 1e-6, pitch = random.uniform(-0.3, 0.3);
    Vec before, at, after;
    sms::table_bicubic(t.table, node - step, pitch, before);
    sms::table_bicubic(t.table, node, pitch, at);
    sms::table_bicubic(t.table, node + step, pitch, after);
    CHECK(largest((after - at) / step - (at - before) / step) < 1e-2);  // slopes are of order 10
  }
}

TEST_CASE("the edges belong to the table; one step of rounding beyond is outside, and nothing is written") {
  const OwningTable<float> t(axis<float>(201, -0.1, 0.1), axis<float>(31, -0.07, 0.03), axis<float>(1, 0.5, 0.5),
                             [](const Vec& q) { return Vec(q(0), q(1), 1.0); });
  const float inf = std::numeric_limits<float>::infinity();
  for (const auto lookup : {sms::table_bilinear<float>, sms::table_bicubic<float>}) {
    for (const float roll : {-0.1f, 0.1f}) {
      for (const float pitch : {-0.07f, 0.03f}) {
        sms::Vec3<float> found(7.0f, 7.0f, 7.0f);
        CHECK(lookup(t.table, roll, pitch, found) == sms_status::SMS_OK);
        CHECK(std::abs(found(0) - roll) < 1e-7f);
        CHECK(std::abs(found(1) - pitch) < 1e-7f);
        found.setConstant(7.0f);
        CHECK(lookup(t.table, std::nextafter(roll, roll * inf), pitch, found) == sms_status::SMS_OUT_OF_RANGE);
        CHECK(lookup(t.table, roll, std::nextafter(pitch, pitch * inf), found) == sms_status::SMS_OUT_OF_RANGE);
        CHECK(found.isConstant(7.0f));
      }
    }
  }
}

TEST_CASE("bad input: a status, and nothing is written") {
  const auto number = [](const Vec&) { return Vec(1.0, 2.0, 3.0); };
  const sms::TableAxis<double> wide = axis<double>(5, -0.1, 0.1), heights = axis<double>(4, 0.4, 0.6);
  const OwningTable<double> flat(wide, wide, axis<double>(1, 0.5, 0.5), number);
  const OwningTable<double> deep(wide, wide, heights, number);
  const OwningTable<double> few(axis<double>(3, -0.1, 0.1), wide, axis<double>(3, 0.4, 0.6), number);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Vec found(7.0, 7.0, 7.0);
  for (const auto lookup : {sms::table_bilinear<double>, sms::table_bicubic<double>}) {
    CHECK(lookup(flat.table, nan, 0.0, found) == sms_status::SMS_NOT_A_NUMBER);
    CHECK(lookup(flat.table, 0.0, -inf, found) == sms_status::SMS_NOT_A_NUMBER);
    CHECK(lookup(deep.table, 0.0, 0.0, found) == sms_status::SMS_OUT_OF_RANGE);
  }
  for (const auto lookup : {sms::table_trilinear<double>, sms::table_tricubic<double>}) {
    CHECK(lookup(deep.table, 0.0, 0.0, nan, found) == sms_status::SMS_NOT_A_NUMBER);
    CHECK(lookup(deep.table, 0.2, 0.0, 0.5, found) == sms_status::SMS_OUT_OF_RANGE);
    CHECK(lookup(deep.table, 0.0, 0.0, 0.61, found) == sms_status::SMS_OUT_OF_RANGE);
    CHECK(lookup(deep.table, 0.0, 0.0, 0.39, found) == sms_status::SMS_OUT_OF_RANGE);
    CHECK(lookup(flat.table, 0.0, 0.0, 0.5, found) == sms_status::SMS_OUT_OF_RANGE);
  }
  CHECK(sms::table_tricubic(few.table, 0.0, 0.0, 0.5, found) == sms_status::SMS_OUT_OF_RANGE);
  CHECK(largest(found - Vec(7.0, 7.0, 7.0)) < 1e-300);
  CHECK(sms::table_trilinear(few.table, 0.0, 0.0, 0.5, found) == sms_status::SMS_OK);
}

TEST_CASE("float agrees with double, and the C ABI with both") {
  Random random;
  const OwningTable<double> t(axis<double>(21, -0.1, 0.1), axis<double>(21, -0.1, 0.1), axis<double>(5, 0.49, 0.51),
                              solved);
  const OwningTable<float> tf(axis<float>(21, -0.1, 0.1), axis<float>(21, -0.1, 0.1), axis<float>(5, 0.49, 0.51),
                              solved);
  const auto c_axis = [](const auto& a, auto& to) { to = {a.count, a.lower, a.upper, a.reciprocal_step}; };
  sms_table c;
  sms_tablef cf;
  c_axis(t.table.roll, c.roll), c_axis(t.table.pitch, c.pitch), c_axis(t.table.height, c.height);
  c_axis(tf.table.roll, cf.roll), c_axis(tf.table.pitch, cf.pitch), c_axis(tf.table.height, cf.height);
  c.extension = t.table.extension;
  cf.extension = tf.table.extension;
  for (int i = 0; i < sms_test::count; ++i) {
    const Vec q = random_place(random, t.table);
    const sms::Vec3<float> qf(float(q(0)), float(q(1)), float(q(2)));
    Vec found;
    double from_c[3];
    float from_cf[3];
    REQUIRE(sms::table_tricubic(t.table, q(0), q(1), q(2), found) == sms_status::SMS_OK);
    REQUIRE(sms_table_tricubic(&c, q(0), q(1), q(2), from_c) == sms_status::SMS_OK);
    REQUIRE(sms_table_tricubicf(&cf, qf(0), qf(1), qf(2), from_cf) == sms_status::SMS_OK);
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(from_c[k] - found(k)) < 1e-15);
      CHECK(std::abs(double(from_cf[k]) - found(k)) < 5e-7);  // 64 nodes of 0.2 m, summed
    }
    REQUIRE(sms_table_trilinear(&c, q(0), q(1), q(2), from_c) == sms_status::SMS_OK);
    REQUIRE(sms_table_trilinearf(&cf, qf(0), qf(1), qf(2), from_cf) == sms_status::SMS_OK);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(double(from_cf[k]) - from_c[k]) < 2e-7);
  }
}
