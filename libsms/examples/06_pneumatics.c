/* A valve charges a chamber that stands still: mass flow, and the rate of the pressure, from ambient to nearly the supply
 * pressure, by both laws of the flow. Build: cc 06_pneumatics.c -lsms -lm */
#include <stdio.h>

#include "sms/sms.h"

int main(void) {
  sms_params params;
  sms_valve_ports ports;
  sms_edge_flows classic, iso;
  sms_actuator_flows flows;
  sms_chamber_space lower, upper;
  sms_gas rate;
  int i;

  if (sms_params_default(&params) != SMS_OK || sms_chamber_spaces(&params, 0.2, 0.0, &lower, &upper) != SMS_OK) {
    return 1;
  }
  ports.supply.pressure = params.supply_pressure;
  ports.supply.temperature = ports.lower.temperature = params.air_temperature;
  ports.exhaust.pressure = params.ambient_pressure;
  ports.exhaust.temperature = params.air_temperature;
  ports.upper = ports.exhaust;
  printf("pressure [kPa]  by area [g/s]  by the tables [g/s]  rising by [kPa/s]\n");
  for (i = 0; i <= 8; ++i) {
    ports.lower.pressure = params.ambient_pressure + 50.0e3 * i;
    if (sms_valve_flows(&params, SMS_VALVE_CLASSIC, SMS_CHAMBER_POLYTROPIC, 6.0, &ports, &classic) != SMS_OK ||
        sms_valve_flows(&params, SMS_VALVE_ISO_0_4_MPA, SMS_CHAMBER_POLYTROPIC, 6.0, &ports, &iso) != SMS_OK ||
        sms_chamber_flows(&params, &iso, &ports, &flows) != SMS_OK ||
        sms_chamber_rate(&params, SMS_CHAMBER_POLYTROPIC, &ports.lower, &lower, &flows.lower, &rate) != SMS_OK) {
      return 1;
    }
    printf("%14.0f  %13.3f  %19.3f  %17.1f\n", 1e-3 * ports.lower.pressure, 1e3 * classic.supply_lower,
           1e3 * iso.supply_lower, 1e-3 * rate.pressure);
  }
  return !(iso.supply_lower >= 0.0);
}
