// One actuator on the bench.
#include "plant_model.hpp"

namespace sms_fmi {
namespace {

struct OfBench {
  using Plant = sms::Bench<double>;
  static constexpr Kind kind = Kind::bench;
  static std::vector<std::string> columns() { return bench_columns(); }
  static std::vector<std::string> commands() { return {"valve_command"}; }
  static std::vector<std::string> loads() { return {"load_force"}; }

  static sms_status make(const Reader& read, Plant& plant) {
    plant = sms::make_bench(read.params(), laws_of(read));
    return SMS_OK;
  }
  static sms_status rest(const Reader& read, const Plant& plant, Plant::State& state) {
    state = sms::bench_at_rest(plant, read.number("start_extension"), read.number("load_force"),
                               read.number("start_mean_pressure"));
    return SMS_OK;
  }
  static Plant::Input input(const Reader& read) { return {read.number("valve_centre"), read.number("load_force")}; }
  static void set_load(const std::vector<double>& load, Plant::Input& input) { input.load_force = load[0]; }
};

}  // namespace

std::vector<std::string> bench_columns() { return all_columns(OfBench::Plant()); }

std::unique_ptr<Model> make_bench() { return std::unique_ptr<Model>(new PlantModel<OfBench>); }

}  // namespace sms_fmi
