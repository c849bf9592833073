/* The version of all programs, of the library and of the package: this is the one place that says it. */
#ifndef ALE_BASE_VERSION_H
#define ALE_BASE_VERSION_H

#define ALE_VERSION "0.1.0"

#endif
