// What an FMU instance runs: a plant of simulate.hpp, or a position loop. The equations are those of include/sms.
//
// Time is that since the beginning of the run. Inputs are looked at on multiples of the control period, as a controller's
// converter does; a communication step that ends between two of them shows the plant there and changes nothing. So a run
// has the same bits whatever the steps of its master are, as long as the inputs on those multiples are the same.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sms/sms.h"
#include "variables.hpp"

namespace sms_fmi {

class Model {
 public:
  virtual ~Model() = default;

  // From the parameters and inputs among the values, to where outputs can be written.
  virtual sms_status begin(const Values& values) = 0;
  // To `end`, s, with the inputs among the values.
  virtual sms_status advance(const Values& values, double end) = 0;
  // Where it stands, among the values.
  virtual sms_status write_outputs(Values& values) = 0;
  // What a status means here, in words.
  virtual std::string why(sms_status status) const = 0;

  // All that changes while it runs, as octets of this binary; after begin() with the same parameters.
  virtual std::string moment() const = 0;
  virtual bool go_to(const std::string& moment) = 0;
};

std::unique_ptr<Model> make_bench();
std::unique_ptr<Model> make_platform();
std::unique_ptr<Model> make_tank();
std::unique_ptr<Model> make_controller();
std::unique_ptr<Model> make_model(Kind kind);

// Columns of a simulated run; none of a controller.
std::vector<std::string> bench_columns();
std::vector<std::string> platform_columns();
std::vector<std::string> tank_columns();
std::vector<std::string> columns_of(Kind kind);

}  // namespace sms_fmi
