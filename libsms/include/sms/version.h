/* The one place where the version number stands: CMake, pip, the C ABI and the reports read it here. */
#ifndef SMS_VERSION_H
#define SMS_VERSION_H

#define SMS_VERSION "0.1.0"

#endif
