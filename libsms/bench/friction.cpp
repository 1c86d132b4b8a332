// The friction force through the C ABI, as a controller or another language calls it: one call a sample.
#include <random>
#include <vector>

#include "bench.hpp"
#include "sms/sms.h"

namespace sms_timing {
namespace {

constexpr int kSamples = 20000;

template <typename Piston, typename Real>
std::vector<Piston> random_pistons() {
  std::mt19937_64 engine(1);
  const auto uniform = [&engine](double lower, double upper) {
    return static_cast<Real>(std::uniform_real_distribution<double>(lower, upper)(engine));
  };
  std::vector<Piston> pistons(kSamples);
  for (Piston& piston : pistons) {
    piston = {uniform(0.0, 0.4), uniform(-0.3, 0.3), uniform(-2.0, 2.0), uniform(1e5, 5e5), uniform(1e5, 5e5)};
  }
  return pistons;
}

template <typename Real, typename Params, typename Piston>
void one_call_a_sample(const char* name, const Params& params, Real (*equation)(const Params*, const Piston*)) {
  const std::vector<Piston> pistons = random_pistons<Piston, Real>();
  volatile Real sum = Real(0);  // volatile: the result is used, so the work is done
  measure(name, kSamples, [&] {
    Real total = Real(0);
    for (const Piston& piston : pistons) {
      total += equation(&params, &piston);
    }
    sum = total;
  });
}

}  // namespace

void friction() {
  sms_params params;
  sms_params_default(&params);
  one_call_a_sample("friction", params, &sms_friction);
  sms_paramsf paramsf;
  sms_params_defaultf(&paramsf);
  one_call_a_sample("friction, float", paramsf, &sms_frictionf);
}

}  // namespace sms_timing
