"""The kinds of rig, one file each: outputs, unknown inputs, equations, and the experiments it can run.

bench, bench_loop         one actuator; the same with its controller simulated
platform, platform_loop   three actuators under one mechanism; the same with their controllers simulated
mixed_loops               records of both sorts as one problem
tank                      a vessel behind one port of the valve
cylinder                  a cylinder's force balance, fed with measured motion and pressures
pneumatic                 what bench, platform and tank share: laws, windows, the simulated controller
kinds                     which there are, and which one a rig file asks for
"""
