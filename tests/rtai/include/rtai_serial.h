/* RTAI's serial driver; port N is the terminal that the environment names in ALE_RTAI_TTYn. Calls return
 * bytes not done, a negative size asks for all or nothing. */
#ifndef RTAI_SERIAL_H
#define RTAI_SERIAL_H

#include "rtai_lxrt.h"

#define RT_SP_PARITY_NONE 0x00
#define RT_SP_NO_HAND_SHAKE 0x00
#define RT_SP_FIFO_SIZE_8 0x80

#ifdef __cplusplus
extern "C" {
#endif

int rt_spopen(unsigned int tty, unsigned int baud, unsigned int numbits, unsigned int stopbits,
              unsigned int parity, int mode, int fifotrig);
int rt_spclose(unsigned int tty);
int rt_spread(unsigned int tty, char *message, int size);
int rt_spwrite(unsigned int tty, char *message, int size);
int rt_spget_rxavbs(unsigned int tty);
int rt_spget_txfrbs(unsigned int tty);

#ifdef __cplusplus
}
#endif

#endif
