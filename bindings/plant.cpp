// Plants under sampled control: bench, platform and tank, a block of periods at a time.
#include <pybind11/eigen.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "choice.hpp"
#include "exclusive.hpp"
#include "plant_rows.hpp"
#include "rows.hpp"
#include "sms/compiled_mechanism.hpp"
#include "sms/simulate.hpp"

namespace sms_python {
namespace {

using sms::ChamberLaw;
using sms::FrictionLaw;
using sms::MassModel;
using sms::PositionControl;
using sms::ValveLaw;
using Channel = sms::Channel<double>;

sms::ActuatorLaws laws_of(const std::string& valve, const std::string& friction, const std::string& chamber,
                          bool electronics) {
  return {choice<ValveLaw>("valve_law", valve,
                           {{"iso_0_4_mpa", ValveLaw::iso_0_4_mpa},
                            {"iso_0_2_mpa", ValveLaw::iso_0_2_mpa},
                            {"classic", ValveLaw::classic}}),
          choice<FrictionLaw>("friction_law", friction,
                              {{"acceleration_dependent", FrictionLaw::acceleration_dependent},
                               {"two_branch", FrictionLaw::two_branch},
                               {"stribeck", FrictionLaw::stribeck},
                               {"dahl", FrictionLaw::dahl},
                               {"lugre", FrictionLaw::lugre}}),
          choice<ChamberLaw>("chamber_law", chamber,
                             {{"polytropic", ChamberLaw::polytropic}, {"energy", ChamberLaw::energy}}),
          electronics ? sms::DriveLaw::filtered : sms::DriveLaw::direct};
}

PositionControl control_of(const std::string& name) {
  return choice<PositionControl>("controller", name,
                                 {{"open_loop", PositionControl::open_loop},
                                  {"pid", PositionControl::pid},
                                  {"state_feedback", PositionControl::state_feedback}});
}

Channel make_channel(double noise, double low, double high, double resolution, const std::string& rounding) {
  using sms::Rounding;
  Channel channel;
  channel.noise = noise;
  channel.low = low;
  channel.high = high;
  channel.resolution = resolution;
  channel.rounding = choice<Rounding>("rounding", rounding, {{"nearest", Rounding::nearest}, {"down", Rounding::down}});
  return channel;
}

// ---- loads ----

void set_load(const double* /*nothing pushes on a tank*/, sms::TankInput<double>&) {}

void set_load(const double* value, sms::BenchInput<double>& input) { input.load_force = value[0]; }

void set_load(const double* value, sms::PlatformInput<double>& input) {
  input.wrench.force << value[0], value[1], value[2];
  input.wrench.moment << value[3], value[4], value[5];
}

template <typename Plant>
constexpr py::ssize_t load_width() {
  return Plant::legs == 1 ? 1 : 6;
}

// ---- the class ----

template <typename Plant>
class Simulation {
 public:
  using State = typename Plant::State;
  static constexpr double kLeastTolerance = 1e-15;
  static constexpr py::ssize_t kStates = sms::StateVector<State>::size;

  Simulation(const Params& controller, const Plant& plant, const State& initial, const typename Plant::Input& input,
             const std::string& control, bool compensated, bool electronics, double tolerance, double step, bool stiff)
      : params_(controller), run_(plant), readings_(kStates + static_cast<py::ssize_t>(term_names(plant).size())) {
    if (step > 0.0) {
      time_step("step", step);
    } else if (!(tolerance >= kLeastTolerance && tolerance <= 1.0)) {
      throw py::value_error("tolerance = " + number(tolerance) + "; a relative error from " + number(kLeastTolerance) +
                            " to 1 is needed");
    }
    const sms_status status =
        begin_simulation(initial, input, params_, control_of(control), compensated, electronics, tolerance, run_);
    if (status != SMS_OK) {
      raise_status(status, "the simulation cannot begin: " + why(status));
    }
    run_.fixed_step = step;
    run_.stiff = stiff;
    late_ = late_periods(run_);
    width_ = readings_ + static_cast<py::ssize_t>(late_.size());
  }

  // (rows, status, how many rows are done). As many periods as there are rows; each row of the answer is the plant at
  // the moment when the controller took its sample.
  py::tuple advance(const Rows& setpoint, const Rows& noise, const Rows& load) {
    const py::ssize_t n = row_count(setpoint, Plant::legs);
    if (row_count(noise, Plant::legs) != n || row_count(load, load_width<Plant>()) != n) {
      throw py::value_error("as many rows in every array are needed");
    }
    const Output out(n, width_);
    sms_status status = SMS_OK;
    py::ssize_t done = 0;
    {
      const Exclusive alone(this);
      for (; done < n; ++done) {
        status = renew_load(load.data() + done * load_width<Plant>());
        if (status != SMS_OK) {
          break;
        }
        double* const row = out.row(done);
        write_state(run_.run.state, row);
        status =
            sms::take_sample(params_, setpoint.data() + done * Plant::legs, noise.data() + done * Plant::legs, run_);
        write_terms(run_, row + kStates);
        write_readings(run_, noise.data() + done * Plant::legs, row + readings_);
        status = status == SMS_OK ? sms::run_period(run_) : status;
        if (status != SMS_OK) {
          break;
        }
      }
    }
    return py::make_tuple(out.array(), int(status), done);
  }

  // The rows of a whole run as its loggers have them: clocks that are late, then what each channel makes of its reading.
  // draws: (n, readings), standard normal.
  Rows record(const Rows& rows, const std::vector<Channel>& channels, const Rows& draws) const {
    const py::ssize_t n = row_count(rows, width_), count = static_cast<py::ssize_t>(late_.size());
    if (static_cast<py::ssize_t>(channels.size()) != count || row_count(draws, count) != n) {
      throw py::value_error("a channel and a column of draws for every reading are needed");
    }
    const Output out(n, width_);
    for (py::ssize_t i = 0; i < n; ++i) {
      std::copy_n(rows.data() + i * width_, readings_, out.row(i));
      for (py::ssize_t k = 0; k < count; ++k) {
        const std::size_t at = static_cast<std::size_t>(k);
        const py::ssize_t then = std::min(std::max<py::ssize_t>(i - late_[at], 0), n - 1);
        out.row(i)[readings_ + k] =
            channels[at].recorded(rows.data()[then * width_ + readings_ + k], draws.data()[i * count + k]);
      }
    }
    return out.array();
  }

  // The state now, as the first columns of a row have it; it begins a run that goes on from here.
  Eigen::VectorXd state() const {
    Eigen::VectorXd row(kStates);
    write_state(run_.run.state, row.data());
    return row;
  }

  // What a status of advance() means for this plant, in words.
  std::string why(sms_status status) const {
    if (status != SMS_OUT_OF_RANGE) {
      return sms_status_string(status);
    }
    if (*std::max_element(run_.delay_periods, run_.delay_periods + Plant::legs) >= sms::longest_delay()) {
      return "command_delay and the tube's delay together are " + std::to_string(sms::longest_delay()) +
             " control periods or more";
    }
    return "a piston goes so far into its end that a chamber has no volume left; dead_volume_lower and "
           "dead_volume_upper say how much room is there, end_stop_stiffness how far the end gives way";
  }

  double time() const { return run_.run.time; }
  unsigned long evaluations() const { return run_.run.evaluations; }
  unsigned long steps() const { return run_.run.steps; }
  unsigned long rejected() const { return run_.run.rejected; }
  std::vector<std::string> columns() const {
    std::vector<std::string> names = state_names(run_.plant);
    for (const std::string& name : term_names(run_.plant)) {
      names.push_back(name);
    }
    for (const std::string& name : readings()) {
      names.push_back(name);
    }
    return names;
  }
  std::vector<std::string> readings() const { return reading_names(run_); }

 private:
  // What was known of the next step is no longer true when a load has jumped.
  sms_status renew_load(const double* load) {
    if (load_.size() != 0 && std::equal(load_.begin(), load_.end(), load)) {
      return SMS_OK;
    }
    load_.assign(load, load + load_width<Plant>());
    set_load(load, run_.system.input);
    return renew_rate(run_.system, run_.run);
  }

  Params params_;
  sms::Simulation<Plant> run_;
  py::ssize_t readings_;  // column where the readings begin
  py::ssize_t width_ = 0;
  std::vector<int> late_;
  std::vector<double> load_;
};

// The state that was asked for, or the one at rest.
template <typename State>
State initial_state(const std::optional<Eigen::VectorXd>& given, State rest) {
  if (given) {
    if (given->size() != sms::StateVector<State>::size) {
      throw py::value_error("a state of this plant has " + std::to_string(sms::StateVector<State>::size) + " numbers");
    }
    read_state(given->data(), rest);
  }
  return rest;
}

using BenchSimulation = Simulation<sms::Bench<double>>;
using PlatformSimulation = Simulation<sms::Platform<double>>;
using TankSimulation = Simulation<sms::Tank<double>>;

std::unique_ptr<BenchSimulation> make_bench_simulation(const Params& params, const Params& controller,
                                                       const std::string& valve, const std::string& friction,
                                                       const std::string& chamber, const std::string& control,
                                                       bool compensated, bool electronics, double extension,
                                                       double load_force, double mean_pressure, double tolerance,
                                                       double step, bool stiff,
                                                       const std::optional<Eigen::VectorXd>& state) {
  const auto bench = sms::make_bench(params, laws_of(valve, friction, chamber, electronics));
  return std::make_unique<BenchSimulation>(
      controller, bench, initial_state(state, sms::bench_at_rest(bench, extension, load_force, mean_pressure)),
      sms::BenchInput<double>{params.valve_centre, load_force}, control, compensated, electronics, tolerance, step,
      stiff);
}

std::unique_ptr<PlatformSimulation> make_platform_simulation(const std::array<Params, 3>& params,
                                                             const Params& controller, const std::string& valve,
                                                             const std::string& friction, const std::string& chamber,
                                                             int masses, const std::string& control, bool compensated,
                                                             bool electronics, const std::array<double, 3>& q,
                                                             double mean_pressure, double tolerance, double step,
                                                             bool stiff, const std::optional<Eigen::VectorXd>& state) {
  auto platform = sms::make_platform(params[0], laws_of(valve, friction, chamber, electronics),
                                     choice<MassModel>("masses", masses, 4));
  sms::PlatformInput<double> input{sms::Vec3<double>::Zero(), {sms::Vec3<double>::Zero(), sms::Vec3<double>::Zero()}};
  for (int i = 0; i < 3; ++i) {
    platform.params[i] = params[std::size_t(i)];
    input.command(i) = params[std::size_t(i)].valve_centre;
  }
  sms::PlatformState<double> initial;
  const sms_status status =
      sms::platform_at_rest(platform, sms::Vec3<double>(q[0], q[1], q[2]), mean_pressure, initial);
  if (status != SMS_OK) {
    raise_status(status, "the pose to begin with: " + std::string(sms_status_string(status)));
  }
  return std::make_unique<PlatformSimulation>(controller, platform, initial_state(state, initial), input, control,
                                              compensated, electronics, tolerance, step, stiff);
}

std::unique_ptr<TankSimulation> make_tank_simulation(const Params& params, const std::string& valve,
                                                     const std::string& chamber, double pressure, double tolerance,
                                                     double step, bool stiff,
                                                     const std::optional<Eigen::VectorXd>& state) {
  const sms::Tank<double> tank = {params, laws_of(valve, "acceleration_dependent", chamber, false)};
  return std::make_unique<TankSimulation>(params, tank, initial_state(state, sms::tank_at_rest(params, pressure)),
                                          sms::TankInput<double>{params.valve_centre}, "open_loop", false, false,
                                          tolerance, step, stiff);
}

template <typename Bound>
void add_running(py::class_<Bound>& c) {
  c.def("advance", &Bound::advance, py::arg("setpoint"), py::arg("noise"), py::arg("load"),
        "(rows (n, columns), status, rows done) of n control periods; setpoint and noise (n, legs), load (n, 1 or 6).")
      .def(
          "why",
          [](const Bound& bound, int status) {
            return bound.why(choice<sms_status>("status", status, SMS_WRONG_ABI + 1));
          },
          py::arg("status"), "What a status of advance() means for this plant, in words.")
      .def("record", &Bound::record, py::arg("rows"), py::arg("channels"), py::arg("draws"),
           "The rows of a whole run with their readings as loggers have them: late clocks, then a Channel a reading; "
           "draws "
           "(n, readings), standard normal.")
      .def_property_readonly("columns", &Bound::columns, "What each column of a row is.")
      .def_property_readonly("readings", &Bound::readings, "The last of those columns: what the sensors say.")
      .def_property_readonly("state", &Bound::state, "Where the plant is, as the first columns of a row.")
      .def_property_readonly("time", &Bound::time, "s, where the plant is.")
      .def_property_readonly("evaluations", &Bound::evaluations, "Of the plant's derivative, so far.")
      .def_property_readonly("steps", &Bound::steps, "Of the integrator, so far.")
      .def_property_readonly("rejected", &Bound::rejected, "Steps that were tried again smaller, so far.");
}

}  // namespace

void bind_plant(py::module_& m) {
  py::class_<Channel>(m, "Channel", "What a logger's channel makes of a reading: noise, range, rounding (sensor.hpp).")
      .def(py::init(&make_channel), py::kw_only(), py::arg("noise") = 0.0, py::arg("low") = Channel().low,
           py::arg("high") = Channel().high, py::arg("resolution") = 0.0, py::arg("rounding") = "nearest",
           "noise: standard deviation; low, high: where the reading stays; resolution: step of the converter, which "
           "rounds to the \"nearest\" or \"down\".");
  py::class_<BenchSimulation> bench(m, "BenchSimulation", "One actuator under sampled control (simulate.hpp).");
  bench.def(py::init(&make_bench_simulation), py::kw_only(), py::arg("params"), py::arg("controller"),
            py::arg("valve_law"), py::arg("friction_law"), py::arg("chamber_law"), py::arg("control"),
            py::arg("compensated"), py::arg("electronics"), py::arg("extension"), py::arg("load_force"),
            py::arg("mean_pressure"), py::arg("tolerance"), py::arg("step"), py::arg("stiff") = false,
            py::arg("state") = py::none());
  add_running(bench);
  py::class_<PlatformSimulation> platform(m, "PlatformSimulation",
                                          "The platform under sampled control (simulate.hpp).");
  platform.def(py::init(&make_platform_simulation), py::kw_only(), py::arg("params"), py::arg("controller"),
               py::arg("valve_law"), py::arg("friction_law"), py::arg("chamber_law"), py::arg("masses"),
               py::arg("control"), py::arg("compensated"), py::arg("electronics"), py::arg("q"),
               py::arg("mean_pressure"), py::arg("tolerance"), py::arg("step"), py::arg("stiff") = false,
               py::arg("state") = py::none());
  add_running(platform);
  py::class_<TankSimulation> tank(m, "TankSimulation", "The tank of the flow test behind its valve (tank.hpp).");
  tank.def(py::init(&make_tank_simulation), py::kw_only(), py::arg("params"), py::arg("valve_law"),
           py::arg("chamber_law"), py::arg("pressure"), py::arg("tolerance"), py::arg("step"), py::arg("stiff") = false,
           py::arg("state") = py::none());
  add_running(tank);
}

}  // namespace sms_python
