// A plant as a Model: the simulation of simulate.hpp in an open loop, whose set-points are the commands at the valves.
#pragma once

#include <cstring>

#include "model.hpp"
#include "parameters.hpp"
#include "plant_rows.hpp"
#include "sms/simulate.hpp"

namespace sms_fmi {

inline sms::ActuatorLaws laws_of(const Reader& read) {
  return {sms::ValveLaw(read.choice("valve_law")), sms::FrictionLaw(read.choice("friction_law")),
          sms::ChamberLaw(read.choice("chamber_law")),
          read.option("electronics") ? sms::DriveLaw::filtered : sms::DriveLaw::direct};
}

// What each plant has of its own: `Of::make` and `Of::rest` from the values, `Of::command` and `Of::load` as names of
// inputs, `Of::set_load`.
template <typename Of>
class PlantModel : public Model {
 public:
  using Plant = typename Of::Plant;
  using Simulation = sms::Simulation<Plant>;

  PlantModel() : columns_(Of::columns()) {
    for (const std::string& name : columns_) {
      place_.push_back(name.compare(0, 13, "valve_command") == 0 ? -1 : place_of(Of::kind, name_of_column(name)));
    }
    for (int i = 0; i < Plant::legs; ++i) {
      command_[i] = place_of(Of::kind, Of::commands()[std::size_t(i)]);
    }
    for (const std::string& name : Of::loads()) {
      load_place_.push_back(place_of(Of::kind, name));
    }
  }

  sms_status begin(const Values& values) override {
    const Reader read(Of::kind, values);
    Plant plant;
    sms_status status = Of::make(read, plant);
    typename Plant::State state;
    status = status == SMS_OK ? Of::rest(read, plant, state) : status;
    if (status != SMS_OK) {
      return status;
    }
    params_ = read.params();
    now_.reset(new Simulation(plant));
    shown_.reset(new Simulation(plant));
    for (Simulation* s : {now_.get(), shown_.get()}) {
      status = begin_simulation(state, Of::input(read), params_, sms::PositionControl::open_loop, false,
                                read.option("electronics"), read.number("integrator_tolerance"), *s);
      if (status != SMS_OK) {
        return status;
      }
    }
    load_.clear();
    sampled_ = false;
    between_ = 0.0;
    return SMS_OK;
  }

  sms_status advance(const Values& values, double end) override {
    const double close = 1e-6 * now_->period;
    between_ = 0.0;
    while (end - double(now_->sample) * now_->period > close) {
      if (!sampled_) {
        const sms_status status = take(values);
        if (status != SMS_OK) {
          return status;
        }
        sampled_ = true;
      }
      if (double(now_->sample + 1) * now_->period - end > close) {
        between_ = end;
        break;
      }
      const sms_status status = sms::run_period(*now_);
      if (status != SMS_OK) {
        return status;
      }
      sampled_ = false;
    }
    return SMS_OK;
  }

  // Truths as they are, readings as they were at the last sample.
  sms_status write_outputs(Values& values) override {
    each_part(*now_, *shown_, [](const auto& from, auto& to) { to = from; });
    std::vector<double> row(columns_.size());
    const std::size_t states = std::size_t(sms::StateVector<typename Plant::State>::size);
    const std::size_t readings = states + sms_python::term_names(shown_->plant).size();
    if (between_ > 0.0) {
      const sms_status status = sms::run_until<Plant>(between_, *shown_);
      if (status != SMS_OK) {
        return status;
      }
    } else {
      sms::look(*shown_);
      for (int i = 0; i < Plant::legs; ++i) {
        shown_->measured[i] = sms::measure(*shown_, params_, i, 0.0);
      }
    }
    const double no_noise[Plant::legs] = {};
    sms_python::write_state(shown_->run.state, row.data());
    sms_python::write_terms(*shown_, row.data() + states);
    sms_python::write_readings(*shown_, no_noise, row.data() + readings);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool held = place_[i] >= 0 && between_ > 0.0 && variables_of(Of::kind)[std::size_t(place_[i])].sampled;
      if (place_[i] >= 0 && !held) {
        values[std::size_t(place_[i])] = row[i];
      }
    }
    return SMS_OK;
  }

  std::string why(sms_status status) const override {
    if (status != SMS_OUT_OF_RANGE) {
      return sms_status_string(status);
    }
    return now_ == nullptr || now_->sample == 0
               ? "command_delay and the tube's delay together are " + std::to_string(sms::longest_delay()) +
                     " control periods or more, or a chamber has no volume"
               : "a piston goes so far into its end that a chamber has no volume left";
  }

  std::string moment() const override {
    std::string octets(1, sampled_ ? '\1' : '\0');
    put(between_, octets);
    put(double(load_.size()), octets);
    for (const double value : load_) {
      put(value, octets);
    }
    each_part(*now_, *now_, [&octets](const auto& from, const auto&) { put(from, octets); });
    return octets;
  }

  bool go_to(const std::string& octets) override {
    std::size_t at = 1;
    double loads = 0.0;
    if (octets.empty() || !get(octets, at, between_) || !get(octets, at, loads)) {
      return false;
    }
    sampled_ = octets[0] != '\0';
    load_.resize(loads > 0.0 ? load_place_.size() : 0);
    bool complete = true;
    for (double& value : load_) {
      complete = complete && get(octets, at, value);
    }
    each_part(*now_, *now_, [&](const auto&, auto& to) { complete = complete && get(octets, at, to); });
    return complete && at == octets.size();
  }

 private:
  // What of a simulation changes while it runs.
  template <typename From, typename To, typename Visit>
  static void each_part(From& from, To& to, const Visit& visit) {
    visit(from.system.input, to.system.input);
    visit(from.system.terms, to.system.terms);
    visit(from.run, to.run);
    visit(from.sensors, to.sensors);
    visit(from.sample, to.sample);
    for (int i = 0; i < Plant::legs; ++i) {
      visit(from.loop[i], to.loop[i]);
      visit(from.filter[i], to.filter[i]);
      visit(from.line[i], to.line[i]);
      visit(from.measured[i], to.measured[i]);
      visit(from.command[i], to.command[i]);
    }
  }

  template <typename Part>
  static void put(const Part& part, std::string& octets) {
    octets.append(reinterpret_cast<const char*>(&part), sizeof part);
  }

  template <typename Part>
  static bool get(const std::string& octets, std::size_t& at, Part& part) {
    if (octets.size() - at < sizeof part) {
      return false;
    }
    std::memcpy(static_cast<void*>(&part), octets.data() + at, sizeof part);
    at += sizeof part;
    return true;
  }

  sms_status take(const Values& values) {
    std::vector<double> load;
    for (const int place : load_place_) {
      load.push_back(values[std::size_t(place)]);
    }
    sms_status status = SMS_OK;
    if (now_->sample == 0 || load != load_) {  // what was known of the next step is no longer true
      load_ = load;
      Of::set_load(load, now_->system.input);
      status = sms::renew_rate(now_->system, now_->run);
    }
    double setpoint[Plant::legs];
    const double no_noise[Plant::legs] = {};
    for (int i = 0; i < Plant::legs; ++i) {
      setpoint[i] = values[std::size_t(command_[i])];
    }
    return status == SMS_OK ? sms::take_sample(params_, setpoint, no_noise, *now_) : status;
  }

  std::vector<std::string> columns_;
  std::vector<int> place_;  // of each column among the values; -1: it is none of them
  int command_[Plant::legs];
  std::vector<int> load_place_;
  sms::Params<double> params_;
  std::unique_ptr<Simulation> now_;    // at a multiple of the control period
  std::unique_ptr<Simulation> shown_;  // where the master is
  std::vector<double> load_;
  bool sampled_ = false;  // the inputs of this period are taken
  double between_ = 0.0;  // s, where the master is, if between two of them
};

template <typename Plant>
std::vector<std::string> all_columns(const Plant& plant) {
  const sms::Simulation<Plant> any(plant);
  std::vector<std::string> names = sms_python::state_names(plant);
  for (const std::string& name : sms_python::term_names(plant)) {
    names.push_back(name);
  }
  for (const std::string& name : sms_python::reading_names(any)) {
    names.push_back(name);
  }
  return names;
}

}  // namespace sms_fmi
