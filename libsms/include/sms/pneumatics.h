/* libsms, the air of an actuator: valve, mass flows, chambers, for C. Part of sms.h, whose conventions hold here.
 *
 *   command -> spool -> mass flows over four edges, of both chambers -> rates of pressure and temperature
 *
 * These are the terms of which plant.h is made, one by one: for an observer, a feed-forward of the valve, or a simulation
 * of one's own. Only what returns sms_status looks at its inputs; NaN goes through what returns a number.
 *
 * Example: libsms/examples/06_pneumatics.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_PNEUMATICS_H
#define SMS_PNEUMATICS_H

#ifdef __cplusplus
extern "C" {
#endif

/* sms_gas, sms_lag, sms_iso_flow, sms_valve_ports, sms_edge_flows, sms_chamber_space, sms_chamber_flow,
 * sms_actuator_flows; in float sms_gasf, ... */
#define SMS_STRUCTS "sms/pneumatics_structs.def"
#include "sms/structs.h"

typedef enum sms_valve_law {
  SMS_VALVE_ISO_0_4_MPA = 0, /* the table measured at 0.4 MPa gauge: the default */
  SMS_VALVE_ISO_0_2_MPA = 1, /* the one at 0.2 MPa */
  SMS_VALVE_CLASSIC = 2      /* orifice area and discharge coefficient */
} sms_valve_law;

typedef enum sms_chamber_law {
  SMS_CHAMBER_POLYTROPIC = 0, /* eq. 4.30: the default */
  SMS_CHAMBER_ENERGY = 1      /* temperature a state, heat through the wall */
} sms_chamber_law;

/* ---- flow through one orifice (mass_flow.hpp) -------------------------------------------------------------------- */
/* kg/s, positive from the first gas to the second: the classic law over the area, m^2 (eq. 4.20 to 4.22), and ISO 6358
 * (eq. 5.8 and 5.9). */
double sms_classic_mass_flow(const sms_params *params, double area, const sms_gas *from, const sms_gas *to);
float sms_classic_mass_flowf(const sms_paramsf *params, float area, const sms_gasf *from, const sms_gasf *to);
double sms_iso_mass_flow(const sms_params *params, const sms_iso_flow *flow, const sms_gas *from, const sms_gas *to);
float sms_iso_mass_flowf(const sms_paramsf *params, const sms_iso_flowf *flow, const sms_gasf *from,
                         const sms_gasf *to);

/* Sonic conductance, m^3/(s Pa), of an orifice that the classic law describes by its area, m^2: eq. 5.10. */
double sms_sonic_conductance(const sms_params *params, double area);
float sms_sonic_conductancef(const sms_paramsf *params, float area);

/* ---- valve (valve.hpp) ------------------------------------------------------------------------------------------- */
/* Position of the spool, m, at a command, V: the measured cubic (eq. 4.1) and the straight line (eq. 4.2). */
double sms_spool_cubic(const sms_params *params, double voltage);
float sms_spool_cubicf(const sms_paramsf *params, float voltage);
double sms_spool_linear(const sms_params *params, double voltage);
float sms_spool_linearf(const sms_paramsf *params, float voltage);

/* Open area of one port's orifices, m^2, at a position of the spool, m: eq. 4.4. */
double sms_orifice_area(const sms_params *params, double spool);
float sms_orifice_areaf(const sms_paramsf *params, float spool);

/* Distance of the spool from the valve's centre, V, signed: positive feeds the lower chamber; dead_band_change and
 * valve_centre are in it. */
double sms_valve_opening(const sms_params *params, double voltage);
float sms_valve_openingf(const sms_paramsf *params, float voltage);

/* How the spool follows a command, V, limited to 0 to 10 V: its rate, V/s and V/s^2, a lag of second order of
 * valve_frequency and valve_damping_ratio. SMS_WRONG_ABI, SMS_NOT_A_NUMBER. */
sms_status sms_spool_rate(const sms_params *params, const sms_lag *spool, double command, sms_lag *rate);
sms_status sms_spool_ratef(const sms_paramsf *params, const sms_lagf *spool, float command, sms_lagf *rate);

/* Mass flow over the four edges with the spool at `voltage`, V (sections 4.1.2 and 5). The tables' flow follows the
 * chambers' heat ratios, hence their law. SMS_WRONG_ABI, SMS_NOT_A_NUMBER; SMS_OUT_OF_RANGE: there is no such law, or a
 * temperature is not positive. */
sms_status sms_valve_flows(const sms_params *params, sms_valve_law valve, sms_chamber_law chamber, double voltage,
                           const sms_valve_ports *ports, sms_edge_flows *flows);
sms_status sms_valve_flowsf(const sms_paramsf *params, sms_valve_law valve, sms_chamber_law chamber, float voltage,
                            const sms_valve_portsf *ports, sms_edge_flowsf *flows);

/* ---- chambers (chamber.hpp) -------------------------------------------------------------------------------------- */
/* Room of the two chambers at an extension, m, and its rate, m/s: eq. 4.31 and 4.32. SMS_WRONG_ABI, SMS_NOT_A_NUMBER. */
sms_status sms_chamber_spaces(const sms_params *params, double extension, double velocity, sms_chamber_space *lower,
                              sms_chamber_space *upper);
sms_status sms_chamber_spacesf(const sms_paramsf *params, float extension, float velocity, sms_chamber_spacef *lower,
                               sms_chamber_spacef *upper);

/* The flows over the edges and through the cylinder's leaks, sorted by chamber. SMS_WRONG_ABI, SMS_NOT_A_NUMBER. */
sms_status sms_chamber_flows(const sms_params *params, const sms_edge_flows *edges, const sms_valve_ports *ports,
                             sms_actuator_flows *flows);
sms_status sms_chamber_flowsf(const sms_paramsf *params, const sms_edge_flowsf *edges, const sms_valve_portsf *ports,
                              sms_actuator_flowsf *flows);

/* Rates of pressure, Pa/s, and temperature, K/s: eq. 4.30 with heat_share, or the energy equation (eq. 4.27).
 * SMS_WRONG_ABI, SMS_NOT_A_NUMBER; SMS_OUT_OF_RANGE: there is no such law, or pressure, temperature or volume is not
 * positive. */
sms_status sms_chamber_rate(const sms_params *params, sms_chamber_law law, const sms_gas *gas,
                            const sms_chamber_space *space, const sms_chamber_flow *flow, sms_gas *rate);
sms_status sms_chamber_ratef(const sms_paramsf *params, sms_chamber_law law, const sms_gasf *gas,
                             const sms_chamber_spacef *space, const sms_chamber_flowf *flow, sms_gasf *rate);

/* Mass of the air in a volume, m^3: p V / (R T), kg. */
double sms_air_mass(const sms_params *params, const sms_gas *gas, double volume);
float sms_air_massf(const sms_paramsf *params, const sms_gasf *gas, float volume);

#ifdef __cplusplus
}
#endif

#endif
