// Plants under sampled control: bench, platform and tank, a block of periods at a time.
#include <algorithm>
#include <array>
#include <memory>

#include "choice.hpp"
#include "rows.hpp"
#include "sms/simulate.hpp"

namespace sms_python {
namespace {

using sms::ChamberLaw;
using sms::FrictionLaw;
using sms::MassModel;
using sms::PositionControl;
using sms::ValveLaw;

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
          electronics};
}

PositionControl control_of(const std::string& name) {
  return choice<PositionControl>("controller", name,
                                 {{"open_loop", PositionControl::open_loop},
                                  {"pid", PositionControl::pid},
                                  {"state_feedback", PositionControl::state_feedback}});
}

// ---- what a row of the answer holds ----

void add_actuator_names(const std::string& leg, std::vector<std::string>& names) {
  for (const char* name :
       {"chamber_pressure_lower", "chamber_temperature_lower", "chamber_pressure_upper", "chamber_temperature_upper",
        "spool_voltage", "spool_rate", "drive_voltage", "drive_rate", "seal_deflection", "supply_pressure"}) {
    names.push_back(name + leg);
  }
}

std::vector<std::string> state_names(const sms::Bench<double>&) {
  std::vector<std::string> names = {"extension", "velocity"};
  add_actuator_names("", names);
  return names;
}

std::vector<std::string> state_names(const sms::Platform<double>&) {
  std::vector<std::string> names = {"roll", "pitch", "height", "roll_rate", "pitch_rate", "height_rate"};
  for (const char* leg : {"_1", "_2", "_3"}) {
    add_actuator_names(leg, names);
  }
  return names;
}

std::vector<std::string> state_names(const sms::Tank<double>&) {
  return {"tank_pressure", "tank_temperature", "spool_voltage", "spool_rate", "supply_pressure"};
}

std::vector<std::string> term_names(const sms::Tank<double>&) { return {"mass_flow", "valve_command"}; }

std::vector<std::string> term_names(const sms::Bench<double>&) {
  return {"acceleration", "friction", "measured_extension", "valve_command"};
}

std::vector<std::string> term_names(const sms::Platform<double>&) {
  std::vector<std::string> names = {"yaw", "x", "y", "roll_acceleration", "pitch_acceleration", "height_acceleration"};
  for (const char* leg : {"_1", "_2", "_3"}) {
    for (const char* name : {"extension", "velocity", "friction", "measured_extension", "valve_command"}) {
      names.push_back(std::string(name) + leg);
    }
  }
  return names;
}

void write_terms(const sms::Simulation<sms::Tank<double>>& s, double* row) {
  const sms::TankTerms<double>& t = s.system.terms;
  *row++ = t.flow.in - t.flow.out;
  *row++ = s.command[0];
}

void write_terms(const sms::Simulation<sms::Bench<double>>& s, double* row) {
  const sms::BenchTerms<double>& t = s.system.terms;
  *row++ = t.balance.acceleration;
  *row++ = t.balance.friction;
  *row++ = s.measured[0];
  *row++ = s.command[0];
}

void write_terms(const sms::Simulation<sms::Platform<double>>& s, double* row) {
  const sms::PlatformTerms<double>& t = s.system.terms;
  for (const double value : {t.dynamics.pose.yaw, t.dynamics.pose.x, t.dynamics.pose.y}) {
    *row++ = value;
  }
  for (int i = 0; i < 3; ++i) {
    *row++ = t.acceleration(i);
  }
  for (int i = 0; i < 3; ++i) {
    for (const double value :
         {t.extension(i), t.dynamics.motion.extension_rate(i), t.friction(i), s.measured[i], s.command[i]}) {
      *row++ = value;
    }
  }
}

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
  static constexpr py::ssize_t kStates = sms::StateVector<State>::size;

  Simulation(const Params& controller, const Plant& plant, const State& initial, const typename Plant::Input& input,
             const std::string& control, bool compensated, bool electronics, double tolerance, double step)
      : params_(controller), run_(plant), width_(kStates + static_cast<py::ssize_t>(term_names(plant).size())) {
    const sms_status status =
        begin_simulation(initial, input, params_, control_of(control), compensated, electronics, tolerance, run_);
    if (status != SMS_OK) {
      raise_status(status, "the simulation cannot begin: " + why(status));
    }
    run_.fixed_step = step;
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
      const py::gil_scoped_release no_python;
      for (; done < n; ++done) {
        status = renew_load(load.data() + done * load_width<Plant>());
        if (status != SMS_OK) {
          break;
        }
        double* const row = out.row(done);
        sms::vector_of(*out.row_as<State>(done)) = sms::vector_of(run_.run.state);
        status =
            sms::take_sample(params_, setpoint.data() + done * Plant::legs, noise.data() + done * Plant::legs, run_);
        write_terms(run_, row + kStates);
        status = status == SMS_OK ? sms::run_period(run_) : status;
        if (status != SMS_OK) {
          break;
        }
      }
    }
    return py::make_tuple(out.array(), int(status), done);
  }

  // What a status of advance() means for this plant, in words.
  std::string why(sms_status status) const {
    if (status != SMS_OUT_OF_RANGE) {
      return sms_status_string(status);
    }
    if (run_.delay_periods >= sms::longest_delay()) {
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
    return names;
  }

 private:
  // What was known of the next step is no longer true when a load has jumped.
  sms_status renew_load(const double* load) {
    if (load_.size() != 0 && std::equal(load_.begin(), load_.end(), load)) {
      return SMS_OK;
    }
    load_.assign(load, load + load_width<Plant>());
    set_load(load, run_.system.input);
    return run_.system(run_.run.state, run_.run.rate);
  }

  Params params_;
  sms::Simulation<Plant> run_;
  py::ssize_t width_;
  std::vector<double> load_;
};

using BenchSimulation = Simulation<sms::Bench<double>>;
using PlatformSimulation = Simulation<sms::Platform<double>>;
using TankSimulation = Simulation<sms::Tank<double>>;

std::unique_ptr<BenchSimulation> make_bench_simulation(const Params& params, const Params& controller,
                                                       const std::string& valve, const std::string& friction,
                                                       const std::string& chamber, const std::string& control,
                                                       bool compensated, bool electronics, double extension,
                                                       double load_force, double mean_pressure, double tolerance,
                                                       double step) {
  const auto bench = sms::make_bench(params, laws_of(valve, friction, chamber, electronics));
  return std::make_unique<BenchSimulation>(
      controller, bench, sms::bench_at_rest(bench, extension, load_force, mean_pressure),
      sms::BenchInput<double>{params.valve_centre, load_force}, control, compensated, electronics, tolerance, step);
}

std::unique_ptr<PlatformSimulation> make_platform_simulation(const std::array<Params, 3>& params,
                                                             const Params& controller, const std::string& valve,
                                                             const std::string& friction, const std::string& chamber,
                                                             int masses, const std::string& control, bool compensated,
                                                             bool electronics, const std::array<double, 3>& q,
                                                             double mean_pressure, double tolerance, double step) {
  auto platform = sms::make_platform(params[0], laws_of(valve, friction, chamber, electronics), MassModel(masses));
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
  return std::make_unique<PlatformSimulation>(controller, platform, initial, input, control, compensated, electronics,
                                              tolerance, step);
}

std::unique_ptr<TankSimulation> make_tank_simulation(const Params& params, const std::string& valve,
                                                     const std::string& chamber, double pressure, double tolerance,
                                                     double step) {
  const sms::Tank<double> tank = {params, laws_of(valve, "acceleration_dependent", chamber, false)};
  return std::make_unique<TankSimulation>(params, tank, sms::tank_at_rest(params, pressure),
                                          sms::TankInput<double>{params.valve_centre}, "open_loop", false, false,
                                          tolerance, step);
}

template <typename Bound>
void add_running(py::class_<Bound>& c) {
  c.def("advance", &Bound::advance, py::arg("setpoint"), py::arg("noise"), py::arg("load"),
        "(rows (n, columns), status, rows done) of n control periods; setpoint and noise (n, legs), load (n, 1 or 6).")
      .def(
          "why", [](const Bound& bound, int status) { return bound.why(sms_status(status)); }, py::arg("status"),
          "What a status of advance() means for this plant, in words.")
      .def_property_readonly("columns", &Bound::columns, "What each column of a row is.")
      .def_property_readonly("time", &Bound::time, "s, where the plant is.")
      .def_property_readonly("evaluations", &Bound::evaluations, "Of the plant's derivative, so far.")
      .def_property_readonly("steps", &Bound::steps, "Of the integrator, so far.")
      .def_property_readonly("rejected", &Bound::rejected, "Steps that were tried again smaller, so far.");
}

}  // namespace

void bind_plant(py::module_& m) {
  py::class_<BenchSimulation> bench(m, "BenchSimulation", "One actuator under sampled control (simulate.hpp).");
  bench.def(py::init(&make_bench_simulation), py::kw_only(), py::arg("params"), py::arg("controller"),
            py::arg("valve_law"), py::arg("friction_law"), py::arg("chamber_law"), py::arg("control"),
            py::arg("compensated"), py::arg("electronics"), py::arg("extension"), py::arg("load_force"),
            py::arg("mean_pressure"), py::arg("tolerance"), py::arg("step"));
  add_running(bench);
  py::class_<PlatformSimulation> platform(m, "PlatformSimulation",
                                          "The platform under sampled control (simulate.hpp).");
  platform.def(py::init(&make_platform_simulation), py::kw_only(), py::arg("params"), py::arg("controller"),
               py::arg("valve_law"), py::arg("friction_law"), py::arg("chamber_law"), py::arg("masses"),
               py::arg("control"), py::arg("compensated"), py::arg("electronics"), py::arg("q"),
               py::arg("mean_pressure"), py::arg("tolerance"), py::arg("step"));
  add_running(platform);
  py::class_<TankSimulation> tank(m, "TankSimulation", "The tank of the flow test behind its valve (tank.hpp).");
  tank.def(py::init(&make_tank_simulation), py::kw_only(), py::arg("params"), py::arg("valve_law"),
           py::arg("chamber_law"), py::arg("pressure"), py::arg("tolerance"), py::arg("step"));
  add_running(tank);
}

}  // namespace sms_python
