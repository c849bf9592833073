/* What RTAI's configure would have found. */
#ifndef RTAI_CONFIG_H
#define RTAI_CONFIG_H

#define CONFIG_MMU 1
#define CONFIG_RTAI_USE_NEWERR 1
#define CONFIG_RTAI_DRIVERS_SERIAL 1

#endif
