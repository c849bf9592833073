/* Where LCM is joined: a URL looked at before anything is opened, so that what is wrong with it is told in
 * one line. */
#ifndef ALE_LCM_URL_H
#define ALE_LCM_URL_H

#include <stdbool.h>
#include <stdint.h>

enum { ALE_LCM_URL_ERROR = 256, ALE_LCM_PREFIX = 16 };

/* udpm://GROUP:PORT?ttl=N&recv_buf_size=N&prefix=TEXT, each part of which may be missing. The last is ours:
 * what the names of all channels begin with, where several robots share a network. */
typedef struct {
    uint32_t address; /* a multicast address, 239.255.76.67 as 0xefff4c43 */
    uint16_t port;
    uint8_t ttl;           /* 0: messages stay on this machine */
    int32_t receive_bytes; /* asked from the kernel; 0: not said */
    char prefix[ALE_LCM_PREFIX + 1];
} ale_lcm_group_t;

/* The URL to open: url, or where that is NULL or empty the environment's LCM_DEFAULT_URL, else LCM's default.
 * NULL, and one line for people in error: a kind of URL that is not spoken here, no multicast address, no
 * port, no such option. The route is not looked at. */
const char *ale_lcm_url(const char *url, char error[ALE_LCM_URL_ERROR]);

/* True for a URL of udpm, of which ale_lcm_group then takes the parts. */
bool ale_lcm_is_group(const char *url);

/* 0, or -1 and one line in error; the route is not looked at. *group is then undefined. */
int ale_lcm_group(const char *url, ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR]);

/* Whether names of channels may begin so: at most 16 letters, digits and . _ - /; or nothing. */
bool ale_lcm_is_prefix(const char *text);

/* 0 when the computer has a route to the group at this moment, or -1 and one line in error that says how to
 * make one. Makes a socket and closes it again; sends nothing. */
int ale_lcm_route(const ale_lcm_group_t *group, char error[ALE_LCM_URL_ERROR]);

#endif
