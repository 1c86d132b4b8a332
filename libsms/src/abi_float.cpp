#define SMS_REAL float
#define SMS_F(name) name##f
#include "abi.inc"
#include "abi_controller.inc"
#include "abi_dynamics.inc"
#include "abi_kinematics.inc"
#include "abi_plant.inc"
#include "abi_pneumatics.inc"
#include "abi_table.inc"
