// The tank of the flow test.
#include "plant_model.hpp"

namespace sms_fmi {
namespace {

struct OfTank {
  using Plant = sms::Tank<double>;
  static constexpr Kind kind = Kind::tank;
  static std::vector<std::string> columns() { return tank_columns(); }
  static std::vector<std::string> commands() { return {"valve_command"}; }
  static std::vector<std::string> loads() { return {}; }

  static sms_status make(const Reader& read, Plant& plant) {
    plant.params = read.params();
    plant.laws = laws_of(read);
    return SMS_OK;
  }
  static sms_status rest(const Reader& read, const Plant& plant, Plant::State& state) {
    state = sms::tank_at_rest(plant.params, read.number("tank_initial_pressure"));
    return SMS_OK;
  }
  static Plant::Input input(const Reader& read) { return {read.number("valve_centre")}; }
  static void set_load(const std::vector<double>&, Plant::Input&) {}
};

}  // namespace

std::vector<std::string> tank_columns() { return all_columns(OfTank::Plant()); }

std::unique_ptr<Model> make_tank() { return std::unique_ptr<Model>(new PlantModel<OfTank>); }

}  // namespace sms_fmi
