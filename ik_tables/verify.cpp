#include "verify.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "sms/forward_kinematics.hpp"
#include "sms/inverse_kinematics.hpp"
#include "sms/table.hpp"

namespace ik_tables {
namespace {

using Vec = sms::Vec3<double>;

template <typename S>
sms::TableAxis<S> lookup_axis(const std::vector<double>& nodes) {
  const double count = double(nodes.size() - 1), width = nodes.back() - nodes.front();
  return {int(nodes.size()), S(nodes.front()), S(nodes.back()), nodes.size() == 1 ? S(0) : S(count / width)};
}

// The table as libsms takes it.
template <typename S>
struct Lookup {
  std::vector<S> numbers;
  sms::Table<S> table;

  explicit Lookup(const Table& t) : numbers(t.extension.begin(), t.extension.end()) {
    table = {lookup_axis<S>(t.roll), lookup_axis<S>(t.pitch), lookup_axis<S>(t.height), numbers.data()};
  }

  Vec linear(const Vec& q) const {
    return table.height.count == 1 ? at(sms::table_bilinear<S>, q) : at(sms::table_trilinear<S>, q);
  }
  Vec cubic(const Vec& q) const {
    return table.height.count == 1 ? at(sms::table_bicubic<S>, q) : at(sms::table_tricubic<S>, q);
  }

 private:
  using Flat = sms_status(const sms::Table<S>&, const S&, const S&, sms::Vec3<S>&);
  using Deep = sms_status(const sms::Table<S>&, const S&, const S&, const S&, sms::Vec3<S>&);

  Vec at(Flat* look_up, const Vec& q) const {
    sms::Vec3<S> found = sms::Vec3<S>::Zero();
    return checked(look_up(table, S(q(0)), S(q(1)), found), found);
  }
  Vec at(Deep* look_up, const Vec& q) const {
    sms::Vec3<S> found = sms::Vec3<S>::Zero();
    return checked(look_up(table, S(q(0)), S(q(1)), S(q(2)), found), found);
  }
  static Vec checked(sms_status status, const sms::Vec3<S>& found) {
    if (status != SMS_OK) {
      throw std::logic_error("a point of the table was refused: " + std::string(sms_status_string(status)));
    }
    return found.template cast<double>();
  }
};

// Random numbers that are the same with every C++ library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double between(double lower, double upper) { return lower + (upper - lower) * double(engine_() >> 11) * 0x1p-53; }
  std::size_t index(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937_64 engine_;
};

// A cold solve; a point between nodes that were solved has a solution, unless the table is absurdly coarse.
Vec solved(const sms::Geometry<double>& geometry, const Vec& q) {
  sms::Pose<double> pose;
  Vec extension;
  const sms_status status = sms::inverse_kinematics(geometry, q, sms::rest_pose(geometry), pose, extension);
  if (status != SMS_OK) {
    throw BadInput("the table spans poses between its nodes that are " + std::string(sms_status_string(status)));
  }
  return extension;
}

void compare(const sms::Geometry<double>& geometry, const Vec& q, const Vec& truth, const Vec& interpolated,
             Interpolation& errors) {
  errors.extension.add((interpolated - truth).cwiseAbs().maxCoeff());
  sms::Pose<double> pose;
  if (sms::forward_kinematics(geometry, interpolated, sms::rest_pose(geometry), pose) != SMS_OK) {
    ++errors.lost;
    return;
  }
  errors.roll.add(std::abs(pose.roll - q(0)));
  errors.pitch.add(std::abs(pose.pitch - q(1)));
  errors.height.add(std::abs(pose.height - q(2)));
}

template <typename S>
Verification verify_in(const Table& table, const sms::Geometry<double>& geometry, int points, std::uint64_t seed,
                       Progress& progress) {
  const Lookup<S> lookup(table);
  Random random(seed);
  const auto point = [&random](const std::vector<double>& axis) {
    return double(S(random.between(axis.front(), axis.back())));
  };
  Verification result;
  result.linear.possible = true;
  result.cubic.possible =
      std::min(table.roll.size(), table.pitch.size()) >= 4 && (table.height.size() == 1 || table.height.size() >= 4);
  for (int n = 0; n < points; ++n) {
    const std::size_t i = random.index(table.roll.size()), k = random.index(table.pitch.size());
    const std::size_t l = random.index(table.height.size());
    const double* node = &table.extension[3 * ((i * table.pitch.size() + k) * table.height.size() + l)];
    const Vec direct = solved(geometry, {table.roll[i], table.pitch[k], table.height[l]});
    result.nodes.add((direct - Vec(node[0], node[1], node[2])).cwiseAbs().maxCoeff());

    const Vec q(point(table.roll), point(table.pitch), point(table.height));
    const Vec truth = solved(geometry, q);
    compare(geometry, q, truth, lookup.linear(q), result.linear);
    if (result.cubic.possible) {
      compare(geometry, q, truth, lookup.cubic(q), result.cubic);
    }
    progress.share(double(n) / double(points));
  }
  return result;
}

}  // namespace

void Spread::add(double error) {
  largest = std::max(largest, error);
  square_sum += error * error;
  ++count;
}

double Spread::rms() const { return count == 0 ? 0.0 : std::sqrt(square_sum / double(count)); }

double Interpolation::largest() const {
  return std::max({extension.largest, roll.largest, pitch.largest, height.largest});
}

Verification verify(const Table& table, const sms::Geometry<double>& geometry, int points, std::uint64_t seed,
                    Progress& progress) {
  return table.precision == Precision::kFloat ? verify_in<float>(table, geometry, points, seed, progress)
                                              : verify_in<double>(table, geometry, points, seed, progress);
}

}  // namespace ik_tables
