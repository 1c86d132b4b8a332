// Table 3.1 of the dissertation as it is printed: the bodies of the links, which `corrected` reads otherwise
// (bodies.hpp). Centres of gravity at rest in world axes, inertias about them; masses are in params.def.
#pragma once

#include "sms/scalar.hpp"

namespace sms {

template <typename S>
struct PrintedBody {
  Vec3<S> cog;      // m
  Vec3<S> inertia;  // I_xx, I_yy, I_zz, kg m^2
};

template <typename S>
PrintedBody<S> printed_cylinder(int actuator) {
  switch (actuator) {
    case 0:
      return {Vec3<S>(S(1.308360), S(0.0169), S(-0.446408)), Vec3<S>(S(0.363947), S(0.357131), S(0.050876))};
    case 1:
      return {Vec3<S>(S(-0.651288), S(-1.126699), S(-0.445641)), Vec3<S>(S(0.359551), S(0.356058), S(0.050485))};
    default:
      return {Vec3<S>(S(-0.668818), S(1.124622), S(-0.446408)), Vec3<S>(S(0.355342), S(0.365757), S(0.050876))};
  }
}

template <typename S>
PrintedBody<S> printed_piston(int actuator) {
  switch (actuator) {
    case 0:
      return {Vec3<S>(S(1.294688), S(0.01068), S(-0.482190)), Vec3<S>(S(0.183415), S(0.183095), S(0.012805))};
    case 1:
      return {Vec3<S>(S(-0.638091), S(-1.126575), S(-0.482190)), Vec3<S>(S(0.185953), S(0.180556), S(0.012805))};
    default:
      return {Vec3<S>(S(-0.656596), S(1.115891), S(-0.482190)), Vec3<S>(S(0.180397), S(0.186113), S(0.012805))};
  }
}

// The rods in the order of their joints, B4-P4, B5-P5, B6-P6: rows Panhard 2, 3, 1.
template <typename S>
PrintedBody<S> printed_panhard(int rod) {
  switch (rod) {
    case 0:
      return {Vec3<S>(S(0.352049), S(0.541716), S(-0.1041)), Vec3<S>(S(0.002724), S(0.616673), S(0.614145))};
    case 1:
      return {Vec3<S>(S(0.293116), S(-0.575741), S(-0.1041)), Vec3<S>(S(0.463219), S(0.156177), S(0.614145))};
    default:
      return {Vec3<S>(S(-0.645164), S(0.03402), S(-0.1041)), Vec3<S>(S(0.463151), S(0.156245), S(0.614145))};
  }
}

}  // namespace sms
