/* libsms, lookup in a table of extensions, for C: what a controller does that has no time for the solver, or no trust
 * in one. Part of sms.h, whose conventions hold here. ik_tables writes such a table as a C header, this struct
 * included.
 *
 * Example: libsms/examples/04_table.c */
#include "sms/sms.h" /* before the guard: it includes this header */

#ifndef SMS_TABLE_H
#define SMS_TABLE_H

#ifdef __cplusplus
extern "C" {
#endif

/* sms_table_axis, sms_table; in float sms_table_axisf, sms_tablef. */
#define SMS_STRUCTS "sms/table_structs.def"
#include "sms/structs.h"

/* ---- tables (table.hpp) ------------------------------------------------------------------------------------------ */
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
