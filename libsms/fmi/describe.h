/* What `sms export fmu` asks of the binary that it puts into an FMU, beside the functions of FMI: its variables. */
#ifndef SMS_FMI_DESCRIBE_H
#define SMS_FMI_DESCRIBE_H

#if defined(__GNUC__)
#define SMS_FMI_EXPORT __attribute__((visibility("default")))
#else
#define SMS_FMI_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Texts stay as long as the library is loaded. */
typedef struct sms_fmu_variable {
  const char* name;
  const char* unit; /* SI, as pint reads it; "1" where there is none */
  const char* doc;
  const char* choices; /* of an enumeration, from 1 on, with spaces between */
  int type;            /* 0 real, 1 enumeration, 2 boolean */
  int causality;       /* 0 independent, 1 parameter, 2 input, 3 output, 4 local */
  int sampled;         /* changes at multiples of the control period alone */
  double start;
  double lower;
  double upper;
} sms_fmu_variable;

/* kind: 0 bench, 1 platform, 2 tank, 3 controller. What modelDescription.xml has to carry; NULL: there is no such kind. */
SMS_FMI_EXPORT const char* sms_fmu_token(int kind);

/* The variable with this value reference, 0, 1, ...; 0 is returned when there is none. */
SMS_FMI_EXPORT int sms_fmu_describe(int kind, int place, sms_fmu_variable* to);

#ifdef __cplusplus
}
#endif

#endif
