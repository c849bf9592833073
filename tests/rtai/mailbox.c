#include "include/rtai_mbx.h"
#include "internal.h"

enum { KIND_MAILBOX = 3, BYTES = 65536 };

typedef struct {
    bool used;
    int size;
    int first;
    int filled;
    char bytes[BYTES];
} mailbox_t;

static mailbox_t mailboxes[OBJECTS];

static MBX *make(unsigned long name, int size)
{
    for (int k = 0; k < OBJECTS; k++) {
        if (!mailboxes[k].used) {
            MBX *handle = rtai_handle(KIND_MAILBOX, k);
            if (!rtai_register(name, handle)) {
                return NULL;
            }
            mailboxes[k].used = true;
            mailboxes[k].size = size;
            mailboxes[k].first = mailboxes[k].filled = 0;
            return handle;
        }
    }
    return NULL;
}

MBX *rt_typed_mbx_init(unsigned long name, int size, int queue)
{
    (void)queue;
    if (size <= 0 || size > BYTES) {
        return NULL;
    }
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    MBX *handle = make(name, size);
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return handle;
}

int rt_mbx_delete(MBX *handle)
{
    mailbox_t *mailbox = &mailboxes[rtai_slot(KIND_MAILBOX, handle)];
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    const int result = mailbox->used ? 0 : RTE_OBJINV;
    mailbox->used = false;
    rtai_unregister(handle);
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return result;
}

/* Moves what fits, or with `whole` all or nothing; in or out. Returns the bytes left over. */
static int move(MBX *handle, char *message, int size, bool whole, bool in)
{
    mailbox_t *mailbox = &mailboxes[rtai_slot(KIND_MAILBOX, handle)];
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    const int room = in ? mailbox->size - mailbox->filled : mailbox->filled;
    const int part = whole && room < size ? 0 : (room < size ? room : size);
    for (int k = 0; k < part; k++) {
        char *place = &mailbox->bytes[(mailbox->first + (in ? mailbox->filled : 0) + k) % mailbox->size];
        *(in ? place : &message[k]) = in ? message[k] : *place;
    }
    mailbox->first = in ? mailbox->first : (mailbox->first + part) % mailbox->size;
    mailbox->filled += in ? part : -part;
    const int left = mailbox->used ? size - part : RTE_OBJINV;
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return left;
}

int rt_mbx_send_if(MBX *mailbox, void *message, int size)
{
    return move(mailbox, message, size, true, true);
}

int rt_mbx_send_wp(MBX *mailbox, void *message, int size)
{
    return move(mailbox, message, size, false, true);
}

int rt_mbx_receive_if(MBX *mailbox, void *message, int size)
{
    return move(mailbox, message, size, true, false);
}

int rt_mbx_receive_wp(MBX *mailbox, void *message, int size)
{
    return move(mailbox, message, size, false, false);
}
