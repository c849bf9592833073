/* Mailboxes: rings of bytes without borders of messages. Results are bytes not transferred. */
#ifndef RTAI_MBX_H
#define RTAI_MBX_H

#include "rtai_sem.h"

#ifdef __cplusplus
extern "C" {
#endif

MBX *rt_typed_mbx_init(unsigned long name, int size, int queue);
int rt_mbx_delete(MBX *mailbox);
int rt_mbx_send_if(MBX *mailbox, void *message, int size);
int rt_mbx_send_wp(MBX *mailbox, void *message, int size);
int rt_mbx_receive_if(MBX *mailbox, void *message, int size);
int rt_mbx_receive_wp(MBX *mailbox, void *message, int size);

#ifdef __cplusplus
}
#endif

#endif
