/* Where a scanner may hang: stable names first, then USB, never a port twice. */
#ifndef ALE_SERIAL_PORT_CANDIDATES_H
#define ALE_SERIAL_PORT_CANDIDATES_H

#include <stdint.h>

enum { ALE_PORT_PATH = 128, ALE_PORT_CANDIDATES = 32 };

/* Fills out with the paths of DIRECTORY/serial/by-id/(any), DIRECTORY/ttyACM*, DIRECTORY/ttyUSB*, each
 * sorted by name; one that leads to the same device as an earlier one is left out. directory: "/dev".
 * Returns how many there are, at most ALE_PORT_CANDIDATES. */
uint32_t ale_port_candidates(const char *directory, char out[ALE_PORT_CANDIDATES][ALE_PORT_PATH]);

#endif
