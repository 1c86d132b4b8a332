#define SMS_REAL float
#define SMS_F(name) name##f
#include "abi.inc"
