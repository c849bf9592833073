/* Where LCM is joined, looked at before LCM is asked: it prints a page of advice where one line is wanted. */
#ifndef ALE_LCM_URL_H
#define ALE_LCM_URL_H

enum { ALE_LCM_URL_ERROR = 256 };

/* The URL to open: url, or where that is NULL or empty the environment's LCM_DEFAULT_URL, else LCM's default.
 * NULL, and one line for people in error: no kind of URL that LCM knows, no multicast address, no port, no
 * route to the group. Makes a socket and closes it again; sends nothing. */
const char *ale_lcm_url(const char *url, char error[ALE_LCM_URL_ERROR]);

#endif
