/* The one place where the version number stands: CMake, pip, the C ABI and the reports read it here. */
#ifndef SMS_VERSION_H
#define SMS_VERSION_H

#define SMS_VERSION "0.2.0"

/* Number of the C ABI. It grows with every change of a struct, an enum or a function of the headers for C that a program
 * compiled before would misread; `./dev lint` compares them with libsms/abi/. */
#define SMS_ABI 6

#endif
