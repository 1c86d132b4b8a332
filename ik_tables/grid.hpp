// What ik_tables makes, writes and reads back: the extensions at the nodes of roll, pitch and height.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "progress.hpp"
#include "sms/geometry.hpp"

namespace ik_tables {

// A mistake in what the user gave; what() is the sentence that tells him.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class Precision { kFloat, kDouble };

struct Table {
  std::vector<double> roll;       // nodes, rad, evenly spaced
  std::vector<double> pitch;      // rad
  std::vector<double> height;     // m
  std::vector<double> extension;  // m, [roll][pitch][height][actuator]
  Precision precision;            // of every number above: with kFloat each of them is a float
  std::string version;            // of libsms
  std::string geometry_hash;
};

// 201 x 201 x 3, or with several heights 201 x 201 x 5 x 3.
std::vector<std::size_t> shape(const Table& table);

constexpr long kMostNodes = 20'000'000;  // 480 MB in double

double rounded(double number, Precision precision);

// Nodes from lower to upper, these two rounded first; symmetric when these are.
std::vector<double> nodes(double lower, double upper, int count, Precision precision);

// Fills table.extension at the nodes. Every row along pitch starts anew, so the numbers do not depend on how many
// threads share the rows. Throws BadInput with the first node that no pose of the mechanism fits.
void solve(const sms::Geometry<double>& geometry, unsigned threads, Progress& progress, Table& table);

// How the table lies in the stroke.
struct StrokeUse {
  double least;   // extension, m
  double most;    // m
  long beyond;    // nodes at which an actuator would have to leave its stroke
  long of_nodes;  // all
};
StrokeUse stroke_use(const Table& table, double stroke);

}  // namespace ik_tables
