/* libsms, lookup in a table of extensions, for C: what a controller does that has no time for the solver, or no trust
 * in one. Part of sms.h, whose conventions hold here. ik_tables writes such a table as a C header, this struct
 * included.
 *
 * Example: libsms/examples/04_table.c */
#ifndef SMS_TABLE_H
#define SMS_TABLE_H

#include "sms/sms.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- tables (table.hpp) --------------------------------------------------------------------------------------------
 */
/* Evenly spaced nodes of one coordinate. */
typedef struct sms_table_axis {
  int count;              /* of nodes */
  double lower;           /* the first node, rad or m */
  double upper;           /* the last node */
  double reciprocal_step; /* (count - 1) / (upper - lower); 0 for a single node */
} sms_table_axis;

typedef struct sms_table {
  sms_table_axis roll;
  sms_table_axis pitch;
  sms_table_axis height;   /* a single node: a table at one height */
  const double *extension; /* m, [roll][pitch][height][actuator], the last index next to each other */
} sms_table;

typedef struct sms_table_axisf {
  int count;
  float lower;
  float upper;
  float reciprocal_step;
} sms_table_axisf;

typedef struct sms_tablef {
  sms_table_axisf roll;
  sms_table_axisf pitch;
  sms_table_axisf height;
  const float *extension;
} sms_tablef;

/* Extensions at (roll, pitch) from a table at one height: bilinear, or by the Catmull-Rom spline. SMS_NOT_A_NUMBER, or
 * SMS_OUT_OF_RANGE: outside the table, a table of several heights, fewer nodes on an axis than 2 or, bicubic, 4. */
sms_status sms_table_bilinear(const sms_table *table, double roll, double pitch, double extension[3]);
sms_status sms_table_bilinearf(const sms_tablef *table, float roll, float pitch, float extension[3]);
sms_status sms_table_bicubic(const sms_table *table, double roll, double pitch, double extension[3]);
sms_status sms_table_bicubicf(const sms_tablef *table, float roll, float pitch, float extension[3]);

/* At (roll, pitch, height) from a table of several heights, by the same rules. */
sms_status sms_table_trilinear(const sms_table *table, double roll, double pitch, double height, double extension[3]);
sms_status sms_table_trilinearf(const sms_tablef *table, float roll, float pitch, float height, float extension[3]);
sms_status sms_table_tricubic(const sms_table *table, double roll, double pitch, double height, double extension[3]);
sms_status sms_table_tricubicf(const sms_tablef *table, float roll, float pitch, float height, float extension[3]);

#ifdef __cplusplus
}
#endif

#endif
