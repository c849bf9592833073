/* The estimate task takes a lock that nobody else holds. */
#include <pthread.h>

static void ale_planted(void)
{
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
}

#include "planted/into_estimate.h"
