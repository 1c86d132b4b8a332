/* Makes the structs of the file SMS_STRUCTS for both scalars: sms_pose in double, sms_posef in float. In that file
 * SMS_SCALAR stands for the type and SMS_NAME(sms_pose) for the name. To be included once for each such file. */
#define SMS_SCALAR double
#define SMS_NAME(name) name
#include SMS_STRUCTS
#undef SMS_SCALAR
#undef SMS_NAME

#define SMS_SCALAR float
#define SMS_NAME(name) name##f
#include SMS_STRUCTS
#undef SMS_SCALAR
#undef SMS_NAME
#undef SMS_STRUCTS
