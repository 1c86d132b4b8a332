// The bodies that move (dissertation, Table 3.1), and how the table is read.
//
// The platform is top frame and payload in one. Each actuator is a cylinder that swings on the base joint B_i and a
// piston that swings with it and slides; each Panhard rod swings on B_i.
//
// Table 3.1 gives inertias about each body's own centre of gravity, but they make sense only in axes turned by -30 deg
// about z against those of the centres of gravity, and without the products of inertia. The reading `corrected`:
//   - The three actuators are one design, turned by 0, -120 and 120 deg about z. In the turned axes the rows of
//     actuators 1 and 3 show that design from two sides, which determines its I_xx, I_yy and I_xy
//     (from I_xx and I_yy of row 1 and I_xx of row 3).
//   - The design is slender along the actuator n, which stands in the x-z plane: I_yz = 0 and
//     I_xz = (I_zz - (I_xx + I_yy) / 2) n_x / n_z.
//   - All three actuators are that design with the centres of gravity of row 1: cylinder 2's row lacks the 18 mm by
//     which the position sensor pulls the other two aside.
//   - A Panhard rod is slender, its centre of gravity half-way.
// `table` takes the rows for what they say (table_masses.hpp). `platform` leaves the links away. `lumped` does too, but
// hangs each piston on its joint P_i, and on every rod's joint half of the rod: the cheap model for a controller. It
// is wrong by up to 0.02 rad/s^2, 0.03 m/s^2 and 4 N of holding force (tests/test_dynamics.cpp).
#pragma once

#include "sms/geometry.hpp"
#include "sms/table_masses.hpp"

namespace sms {

enum class MassModel { corrected, table, platform, lumped };

// What of it moves.
enum class MovingBodies : int {
  platform,  // the links' masses are none, or lumped into the platform
  all
};

// A rigid body in axes of its own, which whoever holds it states, as well as where cog and inertia are taken from.
template <typename S>
struct Body {
  S mass;           // kg
  Vec3<S> cog;      // m
  Mat3<S> inertia;  // kg m^2
};

template <typename S>
struct Bodies {
  Body<S> platform;    // platform axes; cog from the reference point, inertia about the cog
  Body<S> hung[6];     // cylinder or rod, link axes; cog from B_i, inertia about B_i
  Body<S> sliding[3];  // piston, link axes; cog from P_i, inertia about P_i
  MovingBodies moving;
};

// What a mass m at c adds to the inertia about the origin.
template <typename S>
Mat3<S> point_inertia(const S& mass, const Vec3<S>& c) {
  return mass * (c.squaredNorm() * Mat3<S>::Identity() - c * c.transpose());
}

template <typename S>
Mat3<S> symmetric(const S& xx, const S& yy, const S& zz, const S& xy, const S& xz, const S& yz) {
  Mat3<S> m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

template <typename S>
Mat3<S> turned(const Mat3<S>& axes, const Mat3<S>& inertia) {
  return axes * inertia * axes.transpose();
}

// Two bodies in one: same axes, cogs from the same point, inertias about the cogs.
template <typename S>
Body<S> joined(const Body<S>& a, const Body<S>& b) {
  const S mass = a.mass + b.mass;
  const Vec3<S> cog = (a.mass * a.cog + b.mass * b.cog) / mass;
  return {mass, cog,
          a.inertia + b.inertia + point_inertia(a.mass, Vec3<S>(a.cog - cog)) +
              point_inertia(b.mass, Vec3<S>(b.cog - cog))};
}

// A link's axes: z from B to P, y across the link and the ground-fixed axis e of its universal joint, x = y x z.
template <typename S>
struct LinkAxes {
  Mat3<S> axes;  // columns x, y, z in world axes
  S axis_slope;  // e_z / e_x in these axes
};

template <typename S>
LinkAxes<S> link_axes(const Vec3<S>& direction, const Vec3<S>& joint_axis) {
  using std::sqrt;
  const Vec3<S> across = cross(direction, joint_axis);
  const S scale = S(1) / sqrt(across.squaredNorm());
  LinkAxes<S> a;
  a.axes.col(1) = scale * across;
  a.axes.col(2) = direction;
  a.axes.col(0) = cross(Vec3<S>(a.axes.col(1)), direction);
  a.axis_slope = scale * direction.dot(joint_axis);
  return a;
}

// Axes of link i at rest, and its joints there, world axes.
template <typename S>
struct RestLink {
  Mat3<S> axes;
  Vec3<S> base;
  Vec3<S> joint;
};

template <typename S>
RestLink<S> rest_link(const Geometry<S>& g, int i) {
  const Vec3<S> joint = g.platform[i] + g.reference;
  const Vec3<S> link = joint - g.base[i];
  using std::sqrt;
  return {link_axes(Vec3<S>(link / sqrt(link.squaredNorm())), g.joint_axis[i]).axes, g.base[i], joint};
}

// A body given at rest in world axes, with its cog from a joint: in the link's axes.
template <typename S>
Body<S> in_link_axes(const Mat3<S>& axes, const S& mass, const Vec3<S>& from_joint, const Mat3<S>& inertia) {
  return {mass, axes.transpose() * from_joint, turned(Mat3<S>(axes.transpose()), inertia)};
}

template <typename S>
Body<S> about_joint(const Body<S>& b) {
  return {b.mass, b.cog, b.inertia + point_inertia(b.mass, b.cog)};
}

template <typename S>
Body<S> top_frame(const Params<S>& p, const Geometry<S>& g) {
  return {p.top_frame_mass, Vec3<S>(p.top_frame_cog_x, p.top_frame_cog_y, p.top_frame_cog_z) - g.reference,
          symmetric(p.top_frame_inertia_xx, p.top_frame_inertia_yy, p.top_frame_inertia_zz, S(0), S(0), S(0))};
}

template <typename S>
Body<S> payload(const Params<S>& p, const Geometry<S>& g) {
  return {p.payload_mass, Vec3<S>(p.payload_cog_x, p.payload_cog_y, p.payload_cog_z) - g.reference,
          symmetric(p.payload_inertia_xx, p.payload_inertia_yy, p.payload_inertia_zz, p.payload_inertia_xy,
                    p.payload_inertia_xz, p.payload_inertia_yz)};
}

// The links of the reading `corrected`.
template <typename S>
void corrected_links(const Params<S>& p, const Geometry<S>& g, Bodies<S>& bodies) {
  const RestLink<S> first = rest_link(g, 0);
  const Vec3<S> cylinder = Vec3<S>(p.cylinder_cog_x, p.cylinder_cog_y, p.cylinder_cog_z) - first.base;
  const Vec3<S> piston = Vec3<S>(p.piston_cog_x, p.piston_cog_y, p.piston_cog_z) - first.joint;
  const Mat3<S> cylinder_inertia = symmetric(p.cylinder_inertia_xx, p.cylinder_inertia_yy, p.cylinder_inertia_zz,
                                             p.cylinder_inertia_xy, p.cylinder_inertia_xz, p.cylinder_inertia_yz);
  const Mat3<S> piston_inertia = symmetric(p.piston_inertia_xx, p.piston_inertia_yy, p.piston_inertia_zz,
                                           p.piston_inertia_xy, p.piston_inertia_xz, p.piston_inertia_yz);
  for (int i = 0; i < 3; ++i) {
    const S cosine = i == 0 ? S(1) : S(-0.5), half_root_3 = S(0.86602540378443865);
    const S sine = i == 0 ? S(0) : (i == 1 ? S(-half_root_3) : half_root_3);
    Mat3<S> turn;  // of the design about z
    turn << cosine, -sine, S(0), sine, cosine, S(0), S(0), S(0), S(1);
    const Mat3<S> axes = turn.transpose() * rest_link(g, i).axes;
    bodies.hung[i] = about_joint(in_link_axes(axes, p.cylinder_mass, cylinder, cylinder_inertia));
    bodies.sliding[i] = about_joint(in_link_axes(axes, p.piston_mass, piston, piston_inertia));
  }
  for (int i = 0; i < 3; ++i) {
    const Body<S> rod = {p.panhard_mass, Vec3<S>(S(0), S(0), S(0.5) * g.panhard_length(i)),
                         symmetric(p.panhard_inertia_transverse, p.panhard_inertia_transverse, p.panhard_inertia_axial,
                                   S(0), S(0), S(0))};
    bodies.hung[3 + i] = about_joint(rod);
  }
}

// A printed row of a link, cog from the joint it hangs on.
template <typename S>
Body<S> printed(const RestLink<S>& link, const S& mass, const PrintedBody<S>& row, const Vec3<S>& joint) {
  const Vec3<S>& i = row.inertia;
  return in_link_axes(link.axes, mass, Vec3<S>(row.cog - joint), symmetric(i(0), i(1), i(2), S(0), S(0), S(0)));
}

// The links of the reading `table`.
template <typename S>
void table_links(const Params<S>& p, const Geometry<S>& g, Bodies<S>& bodies) {
  for (int i = 0; i < 3; ++i) {
    const RestLink<S> actuator = rest_link(g, i), rod = rest_link(g, 3 + i);
    bodies.hung[i] = about_joint(printed(actuator, p.cylinder_mass, printed_cylinder<S>(i), actuator.base));
    bodies.sliding[i] = about_joint(printed(actuator, p.piston_mass, printed_piston<S>(i), actuator.joint));
    bodies.hung[3 + i] = about_joint(printed(rod, p.panhard_mass, printed_panhard<S>(i), rod.base));
  }
}

template <typename S>
Bodies<S> make_bodies(const Params<S>& p, const Geometry<S>& g, MassModel model) {
  Bodies<S> bodies;
  bodies.platform = joined(top_frame(p, g), payload(p, g));
  const bool whole = model == MassModel::corrected || model == MassModel::table;
  bodies.moving = whole ? MovingBodies::all : MovingBodies::platform;
  if (model == MassModel::table) {
    table_links(p, g, bodies);
  } else {
    corrected_links(p, g, bodies);
  }
  if (model == MassModel::lumped) {
    for (int i = 0; i < 6; ++i) {
      const S mass = i < 3 ? p.piston_mass : S(0.5) * p.panhard_mass;
      bodies.platform = joined(bodies.platform, Body<S>{mass, g.platform[i], Mat3<S>::Zero()});
    }
  }
  return bodies;
}

}  // namespace sms
