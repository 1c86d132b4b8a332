#include "model.hpp"

namespace sms_fmi {

std::unique_ptr<Model> make_model(Kind kind) {
  switch (kind) {
    case Kind::bench:
      return make_bench();
    case Kind::platform:
      return make_platform();
    case Kind::tank:
      return make_tank();
    case Kind::controller:
      return make_controller();
  }
  return nullptr;
}

std::vector<std::string> columns_of(Kind kind) {
  switch (kind) {
    case Kind::bench:
      return bench_columns();
    case Kind::platform:
      return platform_columns();
    case Kind::tank:
      return tank_columns();
    case Kind::controller:
      break;
  }
  return {};
}

}  // namespace sms_fmi
