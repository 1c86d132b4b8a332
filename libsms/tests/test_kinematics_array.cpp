// Many poses at once are the poses one by one, to the bit, whatever lies beside them.
#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "mechanism_cases.hpp"
#include "sms/kinematics.h"

using namespace sms_test;

namespace {

sms_geometry machine() {
  sms_params params;
  REQUIRE(sms_params_default(&params) == SMS_OK);
  sms_geometry geometry;
  REQUIRE(sms_geometry_from_params(&params, &geometry) == SMS_OK);
  return geometry;
}

struct Answers {
  std::vector<sms_pose> pose;
  std::vector<double> extension;
  std::vector<sms_convergence> convergence;
  std::vector<sms_status> status;
  explicit Answers(std::size_t n)
      : pose(n, sms_pose{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}),
        extension(3 * n, 7.0),
        convergence(n, sms_convergence{-1, -1.0}),
        status(n, SMS_NOT_CONVERGED) {}
};

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void check_same(const Answers& array, const Answers& one) {
  CHECK(same_bits(array.pose, one.pose));
  CHECK(same_bits(array.extension, one.extension));
  CHECK(array.status == one.status);
  bool same = true;  // a struct with a gap in it
  for (std::size_t i = 0; i < one.convergence.size(); ++i) {
    const sms_convergence &a = array.convergence[i], &b = one.convergence[i];
    same = same && a.iterations == b.iterations && std::memcmp(&a.residual, &b.residual, sizeof a.residual) == 0;
  }
  CHECK(same);
}

// Every eighth row, on average, has no solution, in one way or another.
std::vector<double> rows(Random& random, std::size_t n, bool of_pose) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const double beyond[4] = {nan, inf, of_pose ? 0.7 : 1.5, -1e300};
  std::vector<double> numbers;
  for (std::size_t i = 0; i < n; ++i) {
    const bool bad = random.uniform(0.0, 8.0) < 1.0;
    const int which = int(random.uniform(0.0, 3.0)), how = int(random.uniform(0.0, 4.0));
    for (int k = 0; k < 3; ++k) {
      const double good = !of_pose ? random.uniform(0.0, 0.4)
                          : k < 2  ? random.uniform(-0.15, 0.15)
                                   : random.uniform(0.35, 0.65);
      numbers.push_back(bad && k == which ? beyond[how] : good);
    }
  }
  return numbers;
}

std::vector<sms_pose> starts(Random& random, const sms_geometry& geometry, std::size_t n) {
  std::vector<sms_pose> poses(n);
  for (sms_pose& pose : poses) {
    sms_rest_pose(&geometry, &pose);
    pose.yaw += random.uniform(0.0, 0.1);
    pose.height += random.uniform(0.0, 0.3);
    pose.x += random.uniform(-0.02, 0.02);
  }
  return poses;
}

}  // namespace

TEST_CASE("many poses at once have the bits of single ones, with rows among them that have no solution") {
  Random random;
  const sms_geometry geometry = machine();
  const std::size_t many = std::size_t(sms_test::count);
  // One by one, a four, an eight, and each beside others.
  for (const std::size_t n : {std::size_t(0), std::size_t(1), std::size_t(3), std::size_t(4), std::size_t(6),
                              std::size_t(8), std::size_t(15), many}) {
    for (const bool warm : {false, true}) {
      const std::vector<double> q = rows(random, n, true), extension = rows(random, n, false);
      const std::vector<sms_pose> from = starts(random, geometry, n);
      Answers array(n), one(n), forward_array(n), forward_one(n);
      sms_status first = SMS_OK, forward_first = SMS_OK;
      for (std::size_t i = 0; i < n; ++i) {
        const sms_pose* const start = warm ? &from[i] : nullptr;
        one.status[i] = sms_inverse_kinematics(&geometry, &q[3 * i], start, &one.pose[i], &one.extension[3 * i],
                                               &one.convergence[i]);
        forward_one.status[i] = sms_forward_kinematics(&geometry, &extension[3 * i], start, &forward_one.pose[i],
                                                       &forward_one.convergence[i]);
        first = first == SMS_OK ? one.status[i] : first;
        forward_first = forward_first == SMS_OK ? forward_one.status[i] : forward_first;
      }
      const sms_pose* const start = warm ? from.data() : nullptr;
      CHECK(sms_inverse_kinematics_array(&geometry, n, q.data(), start, array.pose.data(), array.extension.data(),
                                         array.convergence.data(), array.status.data()) == first);
      CHECK(sms_forward_kinematics_array(&geometry, n, extension.data(), start, forward_array.pose.data(),
                                         forward_array.convergence.data(),
                                         forward_array.status.data()) == forward_first);
      check_same(array, one);
      check_same(forward_array, forward_one);
    }
  }
}

TEST_CASE("many poses at once may begin where they are written, and nobody need ask how they ended") {
  Random random;
  const sms_geometry geometry = machine();
  const std::size_t n = 10;
  const std::vector<double> q = rows(random, n, true);
  const std::vector<sms_pose> from = starts(random, geometry, n);
  Answers asked(n), unasked(n);
  asked.pose = unasked.pose = from;
  sms_inverse_kinematics_array(&geometry, n, q.data(), from.data(), asked.pose.data(), asked.extension.data(),
                               asked.convergence.data(), asked.status.data());
  sms_inverse_kinematics_array(&geometry, n, q.data(), unasked.pose.data(), unasked.pose.data(),
                               unasked.extension.data(), nullptr, unasked.status.data());
  CHECK(same_bits(asked.pose, unasked.pose));
  CHECK(same_bits(asked.extension, unasked.extension));
  CHECK(asked.status == unasked.status);
}

TEST_CASE("a row does not depend on its neighbours") {
  Random random;
  const sms_geometry geometry = machine();
  const double q[3] = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0.4, 0.6)};
  std::vector<sms_pose> found;
  for (int i = 0; i < 100; ++i) {
    std::vector<double> four = rows(random, 4, true);
    const std::size_t place = std::size_t(random.uniform(0.0, 4.0));
    std::copy_n(q, 3, four.begin() + std::ptrdiff_t(3 * place));
    Answers answers(4);
    sms_inverse_kinematics_array(&geometry, 4, four.data(), nullptr, answers.pose.data(), answers.extension.data(),
                                 nullptr, answers.status.data());
    REQUIRE(answers.status[place] == SMS_OK);
    found.push_back(answers.pose[place]);
  }
  CHECK(same_bits(found, std::vector<sms_pose>(found.size(), found.front())));
}
