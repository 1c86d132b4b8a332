// A signal as it was recorded: plain numbers, whatever is simulated against them.
#pragma once

#include <Eigen/Core>
#include <string>

namespace sms {
namespace estimation {
namespace detail {

// Which way a signal had gone last at a sample, by more than `least`: 1 up, -1 down, 0 if it never did.
double moved_last(const Eigen::VectorXd& signal, int sample, double least);

// Value at the first of some samples, by a parabola through those that are numbers; its slope per second behind it.
// Where they are too few, the nearest value that is one, and no slope.
Eigen::Vector2d beginning(const Eigen::VectorXd& signal, int first, int samples, double step);

// std::invalid_argument for a signal of another length than the command, or with a value that is not finite.
void check_signal(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples);
// The same for readings, which are NaN where nothing is known of the truth but that it lies beyond the sensor's range.
// At least one has to be a number.
void check_readings(const std::string& record, const char* name, const Eigen::VectorXd& signal, Eigen::Index samples);

}  // namespace detail
}  // namespace estimation
}  // namespace sms
