// Kinematics and workspace of the mechanism, a row at a time through the C ABI: what Python gets is what C gets.
#include "rows.hpp"
#include "sms/links.hpp"

namespace sms_python {
namespace {

sms_geometry geometry_of(const Params& params) {
  sms_geometry geometry;
  sms_geometry_from_params(&params, &geometry);
  return geometry;
}

constexpr py::ssize_t kRows = 128;  // at a time, which stay in the cache

// How rows of an array were solved, and what is known of each.
struct Solved {
  Output pose;
  py::array_t<int> iterations;
  py::array_t<double> residual;
  Status status;
  explicit Solved(py::ssize_t n) : pose(n, 6), iterations(n), residual(n), status(n) {}
};

// solve(first row, count, poses, convergence, statuses) for up to kRows at a time.
template <typename Solve>
void solve_rows(py::ssize_t n, Solved& solved, const Solve& solve) {
  int *const steps = solved.iterations.mutable_data(), *const statuses = solved.status.mutable_data();
  double* const error = solved.residual.mutable_data();
  in_blocks(n, [&](py::ssize_t begin, py::ssize_t end) {
    sms_convergence convergence[kRows];
    sms_status status[kRows];
    for (py::ssize_t first = begin; first < end; first += kRows) {
      const py::ssize_t count = std::min(kRows, end - first);
      solve(first, count, solved.pose.row_as<sms_pose>(first), convergence, status);
      for (py::ssize_t k = 0; k < count; ++k) {
        steps[first + k] = convergence[k].iterations;
        error[first + k] = convergence[k].residual;
        statuses[first + k] = status[k];
        if (status[k] != SMS_OK) {
          solved.pose.clear(first + k);
        }
      }
    }
  });
}

py::typing::Tuple<Rows, Rows, py::array_t<int>, py::array_t<double>, Status> inverse_kinematics(const Params& params,
                                                                                                const Column& roll,
                                                                                                const Column& pitch,
                                                                                                const Column& height) {
  const py::ssize_t n = common_size({&roll, &pitch, &height});
  const sms_geometry geometry = geometry_of(params);
  const auto r = roll.unchecked<1>(), p = pitch.unchecked<1>(), h = height.unchecked<1>();
  const Output extension(n, 3);
  Solved solved(n);
  solve_rows(
      n, solved,
      [&](py::ssize_t first, py::ssize_t count, sms_pose* pose, sms_convergence* convergence, sms_status* status) {
        double q[3 * kRows];
        for (py::ssize_t k = 0; k < count; ++k) {
          q[3 * k] = r(first + k);
          q[3 * k + 1] = p(first + k);
          q[3 * k + 2] = h(first + k);
        }
        sms_inverse_kinematics_array(&geometry, size_t(count), q, nullptr, pose, extension.row(first), convergence,
                                     status);
        for (py::ssize_t k = 0; k < count; ++k) {
          if (status[k] != SMS_OK) {
            extension.clear(first + k);
          }
        }
      });
  return py::make_tuple(solved.pose.array(), extension.array(), solved.iterations, solved.residual, solved.status);
}

py::typing::Tuple<Rows, py::array_t<int>, py::array_t<double>, Status> forward_kinematics(const Params& params,
                                                                                          const Rows& extension) {
  const py::ssize_t n = row_count(extension, 3);
  const sms_geometry geometry = geometry_of(params);
  const double* const in = extension.data();
  Solved solved(n);
  solve_rows(
      n, solved,
      [&](py::ssize_t first, py::ssize_t count, sms_pose* pose, sms_convergence* convergence, sms_status* status) {
        sms_forward_kinematics_array(&geometry, size_t(count), in + 3 * first, nullptr, pose, convergence, status);
      });
  return py::make_tuple(solved.pose.array(), solved.iterations, solved.residual, solved.status);
}

Answer inverse_motion(const Params& params, const Rows& q, const Rows& qdot, const Rows& qddot) {
  const py::ssize_t n = common_row_count({&q, &qdot, &qddot}, 3);
  const sms_geometry geometry = geometry_of(params);
  const double *const at = q.data(), *const rate = qdot.data(), *const acceleration = qddot.data();
  const Output motion(n, 18);
  return answer(motion, each_row(n, {&motion}, [&](py::ssize_t i) {
                  sms_pose pose;
                  double extension[3];
                  const sms_status s =
                      sms_inverse_kinematics(&geometry, at + 3 * i, nullptr, &pose, extension, nullptr);
                  return s != SMS_OK ? s
                                     : sms_inverse_motion(&geometry, &pose, rate + 3 * i, acceleration + 3 * i,
                                                          motion.row_as<sms_motion>(i));
                }));
}

Answer forward_motion(const Params& params, const Rows& extension, const Rows& extension_rate,
                      const Rows& extension_acceleration) {
  const py::ssize_t n = common_row_count({&extension, &extension_rate, &extension_acceleration}, 3);
  const sms_geometry geometry = geometry_of(params);
  const double *const at = extension.data(), *const rate = extension_rate.data(),
                      *const acceleration = extension_acceleration.data();
  const Output motion(n, 18);
  return answer(motion, each_row(n, {&motion}, [&](py::ssize_t i) {
                  sms_pose pose;
                  const sms_status s = sms_forward_kinematics(&geometry, at + 3 * i, nullptr, &pose, nullptr);
                  return s != SMS_OK ? s
                                     : sms_forward_motion(&geometry, &pose, rate + 3 * i, acceleration + 3 * i,
                                                          motion.row_as<sms_motion>(i));
                }));
}

// call(geometry, pose, row of the output) for every pose.
template <typename Call>
Answer of_pose(const Params& params, const Rows& pose, py::ssize_t width, const Call& call) {
  const py::ssize_t n = row_count(pose, 6);
  const sms_geometry geometry = geometry_of(params);
  const sms_pose* const at = reinterpret_cast<const sms_pose*>(pose.data());
  const Output output(n, width);
  return answer(output, each_row(n, {&output}, [&](py::ssize_t i) { return call(&geometry, at + i, output.row(i)); }));
}

Answer rectangle_margin(const Params& params, const Rows& rectangle) {
  const py::ssize_t n = row_count(rectangle, 3);
  const sms_geometry geometry = geometry_of(params);
  const double* const in = rectangle.data();
  const Output margin(n, 1);
  return answer(margin, each_row(n, {&margin}, [&](py::ssize_t i) {
                  const double* const r = in + 3 * i;
                  return sms_rectangle_margin(&geometry, r[0], r[1], r[2], margin.row(i));
                }));
}

Answer reach(const Params& params, const Rows& direction) {
  const py::ssize_t n = row_count(direction, 3);
  const sms_geometry geometry = geometry_of(params);
  const double* const in = direction.data();
  const Output angle(n, 1);
  return answer(angle, each_row(n, {&angle}, [&](py::ssize_t i) {
                  const double* const d = in + 3 * i;
                  return sms_reach(&geometry, d[0], d[1], d[2], angle.row(i));
                }));
}

Rows stroke_margin(const Params& params, const Rows& extension) {
  const py::ssize_t n = row_count(extension, 3);
  const sms_geometry geometry = geometry_of(params);
  const double* const in = extension.data();
  const Output margin(n, 1);
  in_blocks(n, [&](py::ssize_t begin, py::ssize_t end) {
    for (py::ssize_t i = begin; i < end; ++i) {
      *margin.row(i) = sms_stroke_margin(&geometry, in + 3 * i);
    }
  });
  return margin.array();
}

Rows carried_points(const Params& params, const Rows& pose, const Rows& at_rest) {
  const py::ssize_t n = row_count(pose, 6), k = row_count(at_rest, 3);
  const sms::Geometry<double> geometry = sms::make_geometry(params);
  const double *const at = pose.data(), *const rest = at_rest.data();
  const Output points(n, 3 * k);
  in_blocks(n, [&](py::ssize_t begin, py::ssize_t end) {
    for (py::ssize_t i = begin; i < end; ++i) {
      const double* const p = at + 6 * i;
      const sms::Pose<double> one = {p[0], p[1], p[2], p[3], p[4], p[5]};
      for (py::ssize_t j = 0; j < k; ++j) {
        const sms::Vec3<double> point(rest[3 * j], rest[3 * j + 1], rest[3 * j + 2]);
        Eigen::Map<sms::Vec3<double>>(points.row(i) + 3 * j) = sms::carried_point(geometry, one, point);
      }
    }
  });
  return points.array();
}

}  // namespace

void bind_kinematics(py::module_& m) {
  m.attr("largest_angle") = sms::largest_angle<double>();
  m.def("inverse_kinematics", &inverse_kinematics, py::arg("params"), py::arg("roll"), py::arg("pitch"),
        py::arg("height"), "(n,) each -> (n, 6) pose, (n, 3) extension, Newton steps, residual, status.");
  m.def("forward_kinematics", &forward_kinematics, py::arg("params"), py::arg("extension"),
        "(n, 3) extension -> (n, 6) pose (roll, pitch, height, yaw, x, y), Newton steps, residual, status.");
  m.def("inverse_motion", &inverse_motion, py::arg("params"), py::arg("q"), py::arg("qdot"), py::arg("qddot"),
        "(n, 3) each -> (n, 18) sms_motion, status.");
  m.def("forward_motion", &forward_motion, py::arg("params"), py::arg("extension"), py::arg("extension_rate"),
        py::arg("extension_acceleration"), "(n, 3) each -> (n, 18) sms_motion, status.");
  m.def(
      "six_leg_inverse",
      [](const Params& params, const Rows& pose) { return of_pose(params, pose, 6, &sms_six_leg_inverse); },
      py::arg("params"), py::arg("pose"), "(n, 6) free poses -> (n, 6) lengths of all links, status.");
  m.def(
      "jacobian",
      [](const Params& params, const Rows& pose) {
        return of_pose(params, pose, 9, [](const sms_geometry* geometry, const sms_pose* at, double* out) {
          return sms_jacobian(geometry, at, reinterpret_cast<double(*)[3]>(out));
        });
      },
      py::arg("params"), py::arg("pose"), "(n, 6) poses -> (n, 9) d extension / d(roll, pitch, height), status.");
  m.def(
      "pose_jacobian",
      [](const Params& params, const Rows& pose) {
        return of_pose(params, pose, 18, [](const sms_geometry* geometry, const sms_pose* at, double* out) {
          return sms_pose_jacobian(geometry, at, reinterpret_cast<double(*)[6]>(out));
        });
      },
      py::arg("params"), py::arg("pose"), "(n, 6) poses -> (n, 18) d extension / d pose, status.");
  m.def(
      "joint_angles",
      [](const Params& params, const Rows& pose) {
        return of_pose(params, pose, 12, [](const sms_geometry* geometry, const sms_pose* at, double* out) {
          return sms_joint_angles_at(geometry, at, reinterpret_cast<sms_joint_angles*>(out));
        });
      },
      py::arg("params"), py::arg("pose"), "(n, 6) poses -> (n, 12) turn of base, then platform joints, rad, status.");
  m.def(
      "conditioning",
      [](const Params& params, const Rows& pose) {
        return of_pose(params, pose, 2, [](const sms_geometry* geometry, const sms_pose* at, double* out) {
          return sms_conditioning(geometry, at, out, out + 1);
        });
      },
      py::arg("params"), py::arg("pose"), "(n, 6) poses -> (n, 2) condition numbers of rods and of all links, status.");
  m.def("carried_points", &carried_points, py::arg("params"), py::arg("pose"), py::arg("at_rest"),
        "(n, 6) poses, (k, 3) points of the platform in the rest pose -> (n, 3 k) where they are, m, world axes.");
  m.def("stroke_margin", &stroke_margin, py::arg("params"), py::arg("extension"), "(n, 3) -> (n, 1) m.");
  m.def("rectangle_margin", &rectangle_margin, py::arg("params"), py::arg("rectangle"),
        "(n, 3) height, roll limit, pitch limit -> (n, 1) least stroke margin on the edges, m, status.");
  m.def("reach", &reach, py::arg("params"), py::arg("direction"),
        "(n, 3) height, unit vector of (roll, pitch) -> (n, 1) largest angle, rad, status.");
}

}  // namespace sms_python
