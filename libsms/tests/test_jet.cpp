// Numbers with derivatives against ceres::Jet, whose operations are the same to the last bit, but for pow: its derivative
// costs no second power here.
#include <ceres/jet.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "estimation/jet.hpp"
#include "random_cases.hpp"

namespace {

constexpr int kWidth = 8;
using Jet = sms::estimation::Jet<kWidth>;
using Reference = ceres::Jet<double, kWidth>;

struct Pair {
  Jet ours;
  Reference theirs;
};

Pair drawn(sms_test::Random* random, double low, double high) {
  Pair pair{Jet(random->uniform(low, high)), {}};
  pair.theirs.a = pair.ours.a;
  for (int k = 0; k < kWidth; ++k) {
    pair.ours.v[k] = pair.theirs.v[k] = k == 2 ? 0.0 : random->uniform(-2.0, 2.0);
  }
  return pair;
}

// The bits, but for the sign of a zero: Eigen's negation of AVX registers is a subtraction from zero.
bool same_number(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)) ||
         (std::fpclassify(a) == FP_ZERO && std::fpclassify(b) == FP_ZERO);
}

bool same(const Jet& ours, const Reference& theirs) {
  bool all = same_number(ours.a, theirs.a);
  for (int k = 0; k < kWidth; ++k) {
    all = all && same_number(ours.v[k], theirs.v[k]);
  }
  return all;
}

bool close(const Jet& ours, const Reference& theirs) {
  bool all = same_number(ours.a, theirs.a);
  for (int k = 0; k < kWidth; ++k) {
    const double size = std::abs(ours.v[k]) + std::abs(theirs.v[k]);
    all = all && (same_number(ours.v[k], theirs.v[k]) || std::abs(ours.v[k] - theirs.v[k]) < 1e-13 * (1.0 + size));
  }
  return all;
}

// of_two(f, g), of_one(f) and of_plain(f, number) are called with either kind.
template <typename Function>
void check_two(const char* name, const Pair& f, const Pair& g, const Function& of_two) {
  INFO(name, " of ", f.ours.a, " and ", g.ours.a);
  CHECK(same(of_two(f.ours, g.ours), of_two(f.theirs, g.theirs)));
}

Pair negative(Pair pair) {
  pair.ours = -pair.ours;
  pair.theirs = -pair.theirs;
  return pair;
}

template <typename Function>
void check_one(const char* name, const Pair& f, const Function& of_one) {
  INFO(name, " of ", f.ours.a);
  CHECK(same(of_one(f.ours), of_one(f.theirs)));
}

TEST_CASE("arithmetic with derivatives has the bits of ceres::Jet") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Pair f = drawn(&random, -3.0, 3.0), g = drawn(&random, -3.0, 3.0);
    const double s = random.uniform(-3.0, 3.0);
    check_two("+", f, g, [](const auto& a, const auto& b) { return a + b; });
    check_two("-", f, g, [](const auto& a, const auto& b) { return a - b; });
    check_two("*", f, g, [](const auto& a, const auto& b) { return a * b; });
    check_two("/", f, g, [](const auto& a, const auto& b) { return a / b; });
    check_two("+= *", f, g, [](auto a, const auto& b) { return (a += b) *= b; });
    check_two("-= /", f, g, [](auto a, const auto& b) { return (a -= b) /= b; });
    check_one("negative", f, [](const auto& a) { return -a; });
    check_one("+ number", f, [s](const auto& a) { return (a + s) * (s + a); });
    check_one("- number", f, [s](const auto& a) { return (a - s) * (s - a); });
    check_one("* number", f, [s](const auto& a) { return a * s - s * a * s; });
    check_one("/ number", f, [s](const auto& a) { return a / s + s / a; });
    CHECK((f.ours < g.ours) == (f.theirs < g.theirs));
    CHECK((f.ours >= g.ours) == (f.theirs >= g.theirs));
    CHECK((f.ours > s) == (f.theirs > s));
    CHECK((s <= g.ours) == (s <= g.theirs));
  }
}

TEST_CASE("functions with derivatives have the bits of ceres::Jet") {
  sms_test::Random random;
  for (int i = 0; i < sms_test::count / 10; ++i) {
    const Pair any = drawn(&random, -4.0, 4.0), other = drawn(&random, -4.0, 4.0), above = drawn(&random, 0.0, 4.0);
    check_one("abs", any, [](const auto& a) { return abs(a); });
    check_one("sqrt", above, [](const auto& a) { return sqrt(a); });
    check_one("exp", any, [](const auto& a) { return exp(a); });
    check_one("sin", any, [](const auto& a) { return sin(a); });
    check_one("cos", any, [](const auto& a) { return cos(a); });
    check_one("atan", any, [](const auto& a) { return atan(a); });
    check_one("floor", any, [](const auto& a) { return floor(a); });
    check_one("ceil", any, [](const auto& a) { return ceil(a); });
    check_two("atan2", any, other, [](const auto& a, const auto& b) { return atan2(a, b); });
    CHECK(close(pow(above.ours, other.ours), pow(above.theirs, other.theirs)));
    check_two("pow below zero", any.ours.a > 0.0 ? negative(any) : any, other,
              [](const auto& a, const auto& b) { return pow(a, floor(b) + 0.0 * b); });
  }
  for (const double exponent : {0.5, 1.0, 2.0, -1.0}) {
    const Pair zero = [&] {
      Pair p = drawn(&random, 1.0, 2.0);
      p.ours.a = p.theirs.a = 0.0;
      return p;
    }();
    check_one("pow at zero", zero, [exponent](const auto& a) {
      using Number = std::decay_t<decltype(a)>;
      return pow(a, Number(exponent));
    });
  }
}

TEST_CASE("an effect is absent when neither its parameter nor a derivative against it is there") {
  Jet p(0.0);
  CHECK(is_absent(p));
  p.v[kWidth - 1] = 1.0;
  CHECK(!is_absent(p));
  CHECK(!is_absent(Jet(1e-3)));
}

}  // namespace
