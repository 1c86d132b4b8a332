#include "bind.hpp"

namespace sms_python {

void bind_parallel_mechanism(py::module_& /*m*/) {}

}  // namespace sms_python
