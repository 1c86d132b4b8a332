// The position loop of one actuator, position_loop.hpp: it takes its sample at the beginning of a control period, and its
// output stays until the next. At rest before the first sample, which sees no jump of the extension.
#include "model.hpp"
#include "parameters.hpp"
#include "sms/position_loop.hpp"

namespace sms_fmi {
namespace {

class Controller : public Model {
 public:
  sms_status begin(const Values& values) override {
    const Reader read(Kind::controller, values);
    const sms::Params<double> params = read.params();
    const auto law = read.choice("law") == 0 ? sms::PositionControl::pid : sms::PositionControl::state_feedback;
    settings_ = sms::position_loop_settings(params, law, read.option("compensated"));
    period_ = params.control_period;
    moment_ = {sms::position_loop_at(0.0), params.command_offset, 0.0};
    return SMS_OK;
  }

  sms_status advance(const Values& values, double end) override {
    const double setpoint = values[std::size_t(setpoint_)], extension = values[std::size_t(extension_)];
    while (end - moment_.samples * period_ > 1e-6 * period_) {
      if (moment_.samples < 0.5) {
        moment_.loop = sms::position_loop_at(extension);
      }
      moment_.command = sms::position_loop_step(settings_, moment_.loop, setpoint, extension);
      moment_.samples += 1.0;
    }
    return moment_.command - moment_.command >= 0.0 ? SMS_OK : SMS_NOT_A_NUMBER;
  }

  sms_status write_outputs(Values& values) override {
    values[std::size_t(command_)] = moment_.command;
    return SMS_OK;
  }

  std::string why(sms_status status) const override { return sms_status_string(status); }

  std::string moment() const override { return std::string(reinterpret_cast<const char*>(&moment_), sizeof moment_); }

  bool go_to(const std::string& octets) override {
    if (octets.size() != sizeof moment_) {
      return false;
    }
    octets.copy(reinterpret_cast<char*>(&moment_), sizeof moment_);
    return true;
  }

 private:
  struct Moment {
    sms::PositionLoop<double> loop;
    double command;  // V
    double samples;  // taken so far
  };
  const int setpoint_ = place_of(Kind::controller, "setpoint");
  const int extension_ = place_of(Kind::controller, "measured_extension");
  const int command_ = place_of(Kind::controller, "valve_command");
  sms::PositionLoopSettings<double> settings_;
  double period_ = 1e-3;
  Moment moment_;
};

}  // namespace

std::unique_ptr<Model> make_controller() { return std::unique_ptr<Model>(new Controller); }

}  // namespace sms_fmi
