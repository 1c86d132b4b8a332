// The platform on three actuators.
#include "plant_model.hpp"

namespace sms_fmi {
namespace {

struct OfPlatform {
  using Plant = sms::Platform<double>;
  static constexpr Kind kind = Kind::platform;
  static std::vector<std::string> columns() { return platform_columns(); }
  static std::vector<std::string> commands() { return {"valve_command_1", "valve_command_2", "valve_command_3"}; }
  static std::vector<std::string> loads() {
    return {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"};
  }

  static sms_status make(const Reader& read, Plant& plant) {
    plant = sms::make_platform(read.params(1), laws_of(read), sms::MassModel(read.choice("masses")));
    for (int i = 0; i < 3; ++i) {
      plant.params[i] = read.params(i + 1);
    }
    return SMS_OK;
  }
  static sms_status rest(const Reader& read, const Plant& plant, Plant::State& state) {
    const sms::Vec3<double> q(read.number("start_roll"), read.number("start_pitch"), read.number("start_height"));
    return sms::platform_at_rest(plant, q, read.number("start_mean_pressure"), state);
  }
  static Plant::Input input(const Reader& read) {
    Plant::Input input{sms::Vec3<double>::Zero(), {sms::Vec3<double>::Zero(), sms::Vec3<double>::Zero()}};
    for (int i = 0; i < 3; ++i) {
      input.command(i) = read.params(i + 1).valve_centre;
    }
    return input;
  }
  static void set_load(const std::vector<double>& load, Plant::Input& input) {
    input.wrench.force << load[0], load[1], load[2];
    input.wrench.moment << load[3], load[4], load[5];
  }
};

}  // namespace

std::vector<std::string> platform_columns() {
  const sms::Params<double> any;
  return all_columns(sms::make_platform(any, sms::ActuatorLaws(), sms::MassModel::corrected));
}

std::unique_ptr<Model> make_platform() { return std::unique_ptr<Model>(new PlantModel<OfPlatform>); }

}  // namespace sms_fmi
