#include "lcm/liblcm.h"

#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MAX_WAITING = 256, MOST_BYTES = 65536 };

struct ale_liblcm {
    lcm_t *lcm;
    bool listens;
    ale_lcm_take_t take;
    void *user;
};

ale_liblcm_t *ale_liblcm_open(const char *url)
{
    ale_liblcm_t *liblcm = calloc(1, sizeof *liblcm);
    if (liblcm) {
        liblcm->lcm = lcm_create(url);
    }
    if (liblcm && !liblcm->lcm) {
        free(liblcm);
        return NULL;
    }
    return liblcm;
}

void ale_liblcm_close(ale_liblcm_t *liblcm)
{
    if (liblcm) {
        lcm_destroy(liblcm->lcm);
        free(liblcm);
    }
}

static void take_message(const lcm_recv_buf_t *received, const char *channel, void *user)
{
    const ale_liblcm_t *liblcm = user;
    liblcm->take(liblcm->user, channel, received->data, received->data_size);
}

int ale_liblcm_listen(ale_liblcm_t *liblcm, ale_lcm_take_t take, void *user)
{
    if (liblcm->listens) {
        return 0;
    }
    liblcm->take = take;
    liblcm->user = user;
    lcm_subscription_t *subscription = lcm_subscribe(liblcm->lcm, ".*", take_message, liblcm);
    liblcm->listens = subscription != NULL;
    return subscription ? lcm_subscription_set_queue_capacity(subscription, MAX_WAITING) : -1;
}

int ale_liblcm_descriptor(ale_liblcm_t *liblcm)
{
    return lcm_get_fileno(liblcm->lcm);
}

int ale_liblcm_send(ale_liblcm_t *liblcm, const char *channel, const uint8_t *bytes, size_t count)
{
    return count > MOST_BYTES ? -1 : lcm_publish(liblcm->lcm, channel, bytes, (unsigned)count);
}

int ale_liblcm_receive(ale_liblcm_t *liblcm)
{
    const int handled = lcm_handle_timeout(liblcm->lcm, 0);
    return handled > 0 ? 1 : handled;
}
