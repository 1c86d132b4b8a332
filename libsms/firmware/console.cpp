#include "application.hpp"
namespace sms {
namespace firmware {
void read_console(Application&, const sms_hardware_inputs&) {}
void write_console(Application&, sms_hardware_outputs&) {}
}  // namespace firmware
}  // namespace sms
