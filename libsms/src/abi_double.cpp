#define SMS_REAL double
#define SMS_F(name) name
#include "abi.inc"
