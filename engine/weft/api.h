/* WEFT_API marks the names that a shared library shows, in C and C++. Part of weft.h and weft_c.h.
 *
 * On Windows the mark is needed only while the DLL is built (CMake defines weft_EXPORTS then). A
 * program that uses the DLL calls functions, which need no mark.
 */
#ifndef WEFT_API_H
#define WEFT_API_H

#if !defined(_WIN32)
#define WEFT_API __attribute__((visibility("default")))
#elif defined(weft_EXPORTS)
#define WEFT_API __declspec(dllexport)
#else
#define WEFT_API
#endif

#endif
