// Mechanisms given by data: kinematics, distance from singularity and dynamics, a row a pose. Header-only in libsms.
#include "choice.hpp"
#include "rows.hpp"
#include "sms/parallel_dynamics.hpp"
#include "sms/parallel_path.hpp"

namespace sms_python {
namespace {

using Six = sms::Vec6<double>;
using Legs = py::array_t<double, kInOrder>;

// The mechanism with what is asked of it row after row.
struct Parallel {
  sms::ParallelMechanism<double> mechanism;
  sms::LegEquation equation[6];
  int freedoms;
};

sms::Vec3<double> vector(const double* from) { return {from[0], from[1], from[2]}; }
Six six(const double* from) { return Eigen::Map<const Six>(from); }
void write(const Six& values, double* to) { std::copy_n(values.data(), 6, to); }

// A row of `normal` that is NaN: no plane. A characteristic length of 0: the joints' mean radius.
Parallel make_parallel(const Legs& base, const Legs& platform, const std::vector<int>& length_is,
                       const std::vector<double>& fixed_length, const Legs& normal, const std::vector<int>& driven,
                       double characteristic_length) {
  const py::ssize_t legs = common_row_count({&base, &platform, &normal}, 3);
  if (legs < 1 || legs > sms::kMostLegs || length_is.size() != std::size_t(legs) ||
      fixed_length.size() != std::size_t(legs) || driven.size() != 6) {
    throw py::value_error("one to six legs are needed, each with its kind and length, and six driven coordinates");
  }
  Parallel p = {};
  p.mechanism.legs = int(legs);
  for (int i = 0; i < p.mechanism.legs; ++i) {
    const double* const n = normal.data() + 3 * i;
    const bool in_plane = n[0] - n[0] >= 0.0;
    p.mechanism.leg[i] = {vector(base.data() + 3 * i),
                          vector(platform.data() + 3 * i),
                          choice<sms::LegLength>("length_is", length_is[std::size_t(i)], 3),
                          fixed_length[std::size_t(i)],
                          in_plane,
                          in_plane ? sms::Vec3<double>(vector(n) / std::sqrt(vector(n).squaredNorm()))
                                   : sms::Vec3<double>(0.0, 0.0, 0.0)};
  }
  for (int k = 0; k < 6; ++k) {
    const int coordinate = driven[std::size_t(k)];
    if (coordinate < 0 || coordinate > 5) {
      throw py::value_error("a driven coordinate is a number from 0 to 5");
    }
    p.mechanism.driven[k] = coordinate;
  }
  p.mechanism.characteristic_length =
      characteristic_length > 0.0 ? characteristic_length : sms::mean_platform_radius(p.mechanism);
  if (sms::equations_of(p.mechanism, p.equation) != 6) {
    throw py::value_error("actuated legs, rods and planes must be six equations");
  }
  p.freedoms = sms::actuated_count(p.mechanism);
  return p;
}

// How the searches ended, a row each.
class Ends {
 public:
  explicit Ends(py::ssize_t rows)
      : iterations_(rows),
        residual_(rows),
        singular_(rows),
        steps_(iterations_.mutable_data()),
        error_(residual_.mutable_data()),
        met_(singular_.mutable_data()) {}
  void set(py::ssize_t i, const sms::Search<double>& search) const {
    steps_[i] = search.iterations;
    error_[i] = search.residual;
    met_[i] = search.singular;
  }
  py::array_t<int> iterations_;
  py::array_t<double> residual_;
  py::array_t<bool> singular_;

 private:
  int* steps_;
  double* error_;
  bool* met_;
};

using Found = py::typing::Tuple<Rows, py::array_t<int>, py::array_t<double>, py::array_t<bool>, Status>;

Found complete(const Parallel& p, const Rows& coordinates) {
  const py::ssize_t n = row_count(coordinates, 6);
  const double* const in = coordinates.data();
  const Output pose(n, 6);
  const Ends ends(n);
  const Status status = each_row(n, {&pose}, [&](py::ssize_t i) {
    Six c = six(in + 6 * i);
    sms::Search<double> search;
    const sms_status s = sms::complete_coordinates(p.mechanism, c, search);
    write(c, pose.row(i));
    ends.set(i, search);
    return s;
  });
  return py::make_tuple(pose.array(), ends.iterations_, ends.residual_, ends.singular_, status);
}

Found forward(const Parallel& p, const Rows& length, const Rows& start) {
  const py::ssize_t n = row_count(length, p.freedoms);
  if (row_count(start, 6) != n) {
    throw py::value_error("as many starts as lengths are needed");
  }
  const double *const in = length.data(), *const begin = start.data();
  const Output pose(n, 6);
  const Ends ends(n);
  const Status status = each_row(n, {&pose}, [&](py::ssize_t i) {
    sms::PlatformPose<double> found;
    sms::Search<double> search;
    const sms_status s =
        sms::parallel_forward(p.mechanism, in + p.freedoms * i, sms::pose_of(six(begin + 6 * i)), found, search);
    if (s == SMS_OK) {
      write(sms::coordinates_of(found), pose.row(i));
    }
    ends.set(i, search);
    return s;
  });
  return py::make_tuple(pose.array(), ends.iterations_, ends.residual_, ends.singular_, status);
}

// work(pose, row of the output) for every row of poses.
template <typename Work>
Rows of_pose(const Rows& pose, py::ssize_t width, const Work& work) {
  const py::ssize_t n = row_count(pose, 6);
  const double* const in = pose.data();
  const Output output(n, width);
  in_blocks(n, [&](py::ssize_t begin, py::ssize_t end) {
    for (py::ssize_t i = begin; i < end; ++i) {
      work(sms::pose_of(six(in + 6 * i)), output.row(i));
    }
  });
  return output.array();
}

Rows lengths(const Parallel& p, const Rows& pose) {
  return of_pose(pose, p.mechanism.legs,
                 [&](const sms::PlatformPose<double>& at, double* out) { sms::leg_lengths(p.mechanism, at, out); });
}

Rows jacobian(const Parallel& p, const Rows& pose) {
  return of_pose(pose, 36, [&](const sms::PlatformPose<double>& at, double* out) {
    sms::LegVectors<double> v;
    sms::locate_legs(p.mechanism, at, v);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> rows(out);
    rows = sms::parallel_jacobian(p.mechanism, p.equation, v);
  });
}

Rows distance(const Parallel& p, const Rows& pose) {
  return of_pose(pose, 2, [&](const sms::PlatformPose<double>& at, double* out) {
    const sms::Distance<double> d = sms::distance_from_singularity(p.mechanism, p.equation, at);
    out[0] = d.condition;
    out[1] = d.determinant;
  });
}

Answer crossings(const Parallel& p, const Rows& pose) {
  const py::ssize_t n = row_count(pose, 6);
  const py::ssize_t ways = n > 0 ? n - 1 : 0;
  const double* const in = pose.data();
  const Output output(ways, 8);
  return answer(output, each_row(ways, {&output}, [&](py::ssize_t i) {
                  sms::Crossing<double> crossing;
                  const sms_status s =
                      sms::crossing_between(p.mechanism, six(in + 6 * i), six(in + 6 * (i + 1)), crossing);
                  if (s == SMS_OK) {
                    double* const out = output.row(i);
                    out[0] = crossing.found ? 1.0 : 0.0;
                    out[1] = crossing.fraction;
                    write(crossing.coordinates, out + 2);
                  }
                  return s;
                }));
}

sms::PlatformBody<double> make_body(double mass, const std::array<double, 3>& cog, const Legs& inertia,
                                    const std::array<double, 3>& gravity) {
  if (row_count(inertia, 3) != 3) {
    throw py::value_error("an inertia of shape (3, 3) is needed");
  }
  sms::PlatformBody<double> body;
  body.mass = mass;
  body.cog = vector(cog.data());
  body.inertia = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(inertia.data());
  body.gravity = vector(gravity.data());
  return body;
}

bool all_finite(std::initializer_list<const Six*> vectors) {
  for (const Six* v : vectors) {
    for (int k = 0; k < 6; ++k) {
      if (!sms::is_finite((*v)(k))) {
        return false;
      }
    }
  }
  return true;
}

// From an acceleration the forces of the six equations.
Answer leg_forces(const Parallel& p, const sms::PlatformBody<double>& body, const Rows& pose, const Rows& twist,
                  const Rows& acceleration, const Rows& wrench) {
  const py::ssize_t n = common_row_count({&pose, &twist, &acceleration, &wrench}, 6);
  const double *const at = pose.data(), *const rate = twist.data(), *const given = acceleration.data(),
                      *const load = wrench.data();
  const Output output(n, 6);
  return answer(output, each_row(n, {&output}, [&](py::ssize_t i) {
                  const Six c = six(at + 6 * i), t = six(rate + 6 * i), a = six(given + 6 * i), w = six(load + 6 * i);
                  if (!all_finite({&c, &t, &a, &w})) {
                    return SMS_NOT_A_NUMBER;
                  }
                  sms::ParallelTerms<double> terms;
                  sms::evaluate_parallel(p.mechanism, p.equation, body, sms::pose_of(c), t, w, terms);
                  Six force;
                  const sms_status s = sms::leg_forces(terms, a, force);
                  if (s == SMS_OK) {
                    write(force, output.row(i));
                  }
                  return s;
                }));
}

// From the actuated legs' forces the acceleration of the platform.
Answer acceleration(const Parallel& p, const sms::PlatformBody<double>& body, const Rows& pose, const Rows& twist,
                    const Rows& force, const Rows& wrench) {
  const py::ssize_t n = common_row_count({&pose, &twist, &wrench}, 6);
  if (row_count(force, p.freedoms) != n) {
    throw py::value_error("as many rows in every array are needed");
  }
  const double *const at = pose.data(), *const rate = twist.data(), *const given = force.data(),
                      *const load = wrench.data();
  const Output output(n, 6);
  return answer(output, each_row(n, {&output}, [&](py::ssize_t i) {
                  const Six c = six(at + 6 * i), t = six(rate + 6 * i), w = six(load + 6 * i);
                  bool finite = all_finite({&c, &t, &w});
                  for (int k = 0; k < p.freedoms; ++k) {
                    finite = finite && sms::is_finite(given[p.freedoms * i + k]);
                  }
                  if (!finite) {
                    return SMS_NOT_A_NUMBER;
                  }
                  sms::ParallelTerms<double> terms;
                  sms::evaluate_parallel(p.mechanism, p.equation, body, sms::pose_of(c), t, w, terms);
                  Six a;
                  const sms_status s = sms::platform_acceleration(terms, p.freedoms, given + p.freedoms * i, a);
                  if (s == SMS_OK) {
                    write(a, output.row(i));
                  }
                  return s;
                }));
}

}  // namespace

void bind_parallel_mechanism(py::module_& m) {
  py::class_<sms::PlatformBody<double>>(m, "PlatformBody", "Mass, centre of gravity, inertia about it, gravity; SI.")
      .def(py::init(&make_body), py::arg("mass"), py::arg("cog"), py::arg("inertia"), py::arg("gravity"));
  py::class_<Parallel>(m, "ParallelMechanism", "A mechanism given by data; see sms.mechanism.Mechanism.")
      .def(py::init(&make_parallel), py::arg("base"), py::arg("platform"), py::arg("length_is"),
           py::arg("fixed_length"), py::arg("normal"), py::arg("driven"), py::arg("characteristic_length"))
      .def_readonly("freedoms", &Parallel::freedoms, "Number of actuated legs.")
      .def_property_readonly(
          "characteristic_length", [](const Parallel& p) { return p.mechanism.characteristic_length; }, "m.")
      .def("complete", &complete, py::arg("coordinates"),
           "(n, 6) -> (n, 6) pose that fits rods and planes, Newton steps, residual, singular, status.")
      .def("forward", &forward, py::arg("length"), py::arg("start"),
           "(n, freedoms) lengths, (n, 6) starts -> (n, 6) pose, Newton steps, residual, singular, status.")
      .def("lengths", &lengths, py::arg("pose"), "(n, 6) -> (n, legs), m.")
      .def("jacobian", &jacobian, py::arg("pose"), "(n, 6) -> (n, 36) of the six equations by the twist.")
      .def("distance", &distance, py::arg("pose"), "(n, 6) -> (n, 2) condition number, determinant.")
      .def("crossings", &crossings, py::arg("pose"),
           "(n, 6) -> (n - 1, 8) whether found, fraction of the way, coordinates; status.")
      .def("leg_forces", &leg_forces, py::arg("body"), py::arg("pose"), py::arg("twist"), py::arg("acceleration"),
           py::arg("wrench"), "(n, 6) each -> (n, 6) forces of the six equations, N; status.")
      .def("acceleration", &acceleration, py::arg("body"), py::arg("pose"), py::arg("twist"), py::arg("force"),
           py::arg("wrench"), "(n, 6) each, (n, freedoms) forces -> (n, 6) acceleration; status.");
}

}  // namespace sms_python
