// The three plants: tank (flow test), bench (one actuator), platform (three of them under the mechanism).
//
// All have one shape. Parameters and laws make the plant; a state is a plain struct of S; an input is held between two
// samples of the controller; terms is the workspace, and every field of it says which function fills it:
//
//   sms_status derivative(plant, state, input, terms, rate)
//
// integrate.hpp and integrate_adaptive.hpp take them through time, simulate.hpp closes a controller around bench and
// platform. An effect is a group of parameters whose neutral value leaves every trajectory unchanged to the bit.
#pragma once

#include "sms/bench.hpp"
#include "sms/platform.hpp"
#include "sms/tank.hpp"
