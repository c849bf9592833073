#include "lcm/udpm.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "lcm/assembly.h"
#include "lcm/datagram.h"

enum { RECEIVE_BYTES = 2 << 20, CONTROL_BYTES = 64 };

/* What only those who listen need. */
typedef struct {
    uint8_t datagram[ALE_DATAGRAM_MOST + 1];
    ale_assembly_t assembly;
} buffers_t;

struct ale_udpm {
    ale_lcm_group_t group;
    struct sockaddr_in to;
    int out;
    int in; /* -1: does not listen */
    bool joined;
    uint32_t sequence;
    buffers_t *buffers;
    uint64_t from; /* who sent the last datagram: address and port, both as in the datagram */
    uint64_t malformed;
    uint32_t unheard; /* by the socket of now, and by those before it */
    uint64_t unheard_before;
};

static int udp_socket(void)
{
    return socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

ale_udpm_t *ale_udpm_open(const ale_lcm_group_t *group)
{
    ale_udpm_t *udpm = calloc(1, sizeof *udpm);
    if (!udpm) {
        return NULL;
    }
    const struct in_addr address = {htonl(group->address)};
    *udpm = (ale_udpm_t){.group = *group,
                         .to = {.sin_family = AF_INET, .sin_port = htons(group->port), .sin_addr = address},
                         .out = udp_socket(),
                         .in = -1};
    const uint8_t ttl = group->ttl;
    const uint8_t to_this_machine_too = 1;
    if (udpm->out < 0 || setsockopt(udpm->out, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) < 0 ||
        setsockopt(udpm->out, IPPROTO_IP, IP_MULTICAST_LOOP, &to_this_machine_too, 1) < 0) {
        ale_udpm_close(udpm);
        return NULL;
    }
    return udpm;
}

void ale_udpm_close(ale_udpm_t *udpm)
{
    if (!udpm) {
        return;
    }
    const int saved = errno;
    if (udpm->out >= 0) {
        close(udpm->out);
    }
    if (udpm->in >= 0) {
        close(udpm->in);
    }
    free(udpm->buffers);
    free(udpm);
    errno = saved;
}

/* A multicast datagram of this machine's own comes either marked as looped back, which no network card can
 * do, or over the loopback interface. */
static int keep_to_this_machine(int in)
{
    struct sock_filter accept_own[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)(SKF_AD_OFF + SKF_AD_PKTTYPE)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PACKET_LOOPBACK, 2, 0),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)(SKF_AD_OFF + SKF_AD_IFINDEX)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, if_nametoindex("lo"), 0, 1),
        BPF_STMT(BPF_RET | BPF_K, UINT32_MAX),
        BPF_STMT(BPF_RET | BPF_K, 0),
    };
    const struct sock_fprog filter = {.len = sizeof accept_own / sizeof accept_own[0], .filter = accept_own};
    return setsockopt(in, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter);
}

/* On the loopback, too, in case the route will be moved there. */
static void join_loopback(int in, const ale_udpm_t *udpm)
{
    const struct ip_mreqn loopback = {.imr_multiaddr = udpm->to.sin_addr,
                                      .imr_ifindex = (int)if_nametoindex("lo")};
    if (udpm->group.ttl == 0 && loopback.imr_ifindex > 0) {
        (void)setsockopt(in, IPPROTO_IP, IP_ADD_MEMBERSHIP, &loopback, sizeof loopback);
    }
}

/* Bound to the group's address, so that nothing comes that was sent to an address of the machine's. The
 * filter before that, so that nothing slips in between. */
static int prepare(int in, const ale_udpm_t *udpm)
{
    const int yes = 1;
    const int room = udpm->group.receive_bytes > 0 ? udpm->group.receive_bytes : RECEIVE_BYTES;
    if ((udpm->group.ttl == 0 && keep_to_this_machine(in) < 0) ||
        setsockopt(in, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) < 0) {
        return -1;
    }
    (void)setsockopt(in, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    (void)setsockopt(in, SOL_SOCKET, SO_RXQ_OVFL, &yes, sizeof yes);
    if (bind(in, (const struct sockaddr *)&udpm->to, sizeof udpm->to) < 0) {
        return -1;
    }
    join_loopback(in, udpm);
    return 0;
}

/* A socket that has the port, and no membership yet. -1: errno. */
static int listening_socket(const ale_udpm_t *udpm)
{
    const int in = udp_socket();
    if (in >= 0 && prepare(in, udpm) < 0) {
        const int saved = errno;
        close(in);
        errno = saved;
        return -1;
    }
    return in;
}

/* On the interface that the route names now, as LCM does. The kernel knows a membership by its interface: of
 * one that is there it says so. */
static int join_by_route(const ale_udpm_t *udpm)
{
    const struct ip_mreqn by_route = {.imr_multiaddr = udpm->to.sin_addr};
    const int joined = setsockopt(udpm->in, IPPROTO_IP, IP_ADD_MEMBERSHIP, &by_route, sizeof by_route);
    return joined < 0 && errno != EADDRINUSE ? -1 : 0;
}

int ale_udpm_listen(ale_udpm_t *udpm)
{
    if (udpm->in >= 0) {
        return 0;
    }
    udpm->buffers = udpm->buffers ? udpm->buffers : calloc(1, sizeof *udpm->buffers);
    udpm->in = udpm->buffers ? listening_socket(udpm) : -1;
    if (udpm->in < 0) {
        return -1;
    }
    udpm->joined = join_by_route(udpm) == 0;
    return 0;
}

/* Memberships of interfaces that are gone stay with a socket, and a socket may have twenty: one without
 * them takes the place of the other, under its number. */
static void renew(ale_udpm_t *udpm)
{
    const int fresh = listening_socket(udpm);
    if (fresh >= 0) {
        (void)dup3(fresh, udpm->in, O_CLOEXEC);
        close(fresh);
        udpm->unheard_before += udpm->unheard;
        udpm->unheard = 0;
    }
}

int ale_udpm_join(ale_udpm_t *udpm)
{
    if (udpm->in < 0) {
        char error[ALE_LCM_URL_ERROR];
        return ale_lcm_route(&udpm->group, error);
    }
    const bool was_away = !udpm->joined;
    udpm->joined = join_by_route(udpm) == 0;
    if (udpm->joined ? was_away : errno == ENOBUFS) {
        renew(udpm);
        udpm->joined = join_by_route(udpm) == 0;
    }
    return udpm->joined ? 0 : -1;
}

int ale_udpm_descriptor(const ale_udpm_t *udpm)
{
    return udpm->in;
}

int ale_udpm_send(ale_udpm_t *udpm, const char *channel, const uint8_t *bytes, size_t count)
{
    uint8_t head[ALE_DATAGRAM_HEAD];
    const size_t length = ale_datagram_head(udpm->sequence, channel, head);
    if (length == 0 || count > ALE_DATAGRAM_MOST - length) {
        return -1;
    }
    const union {
        const uint8_t *read_only;
        void *as_iovec_wants_it;
    } payload = {.read_only = bytes};
    struct iovec parts[] = {{head, length}, {payload.as_iovec_wants_it, count}};
    const struct msghdr message = {
        .msg_name = &udpm->to, .msg_namelen = sizeof udpm->to, .msg_iov = parts, .msg_iovlen = 2};
    if (sendmsg(udpm->out, &message, MSG_NOSIGNAL) < 0) {
        return -1;
    }
    udpm->sequence++;
    return 0;
}

/* The kernel tells with each datagram how many it has dropped so far. */
static void note_unheard(ale_udpm_t *udpm, struct msghdr *message)
{
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
            memcpy(&udpm->unheard, CMSG_DATA(c), sizeof udpm->unheard);
        }
    }
}

static void take_datagram(ale_udpm_t *udpm, size_t count, ale_lcm_take_t take, void *user)
{
    ale_datagram_t datagram;
    if (ale_datagram_read(udpm->buffers->datagram, count, &datagram) < 0) {
        udpm->malformed++;
    } else if (!datagram.is_part) {
        take(user, datagram.channel, datagram.bytes, datagram.count);
    } else {
        const ale_partial_t *whole = ale_assembly_add(&udpm->buffers->assembly, udpm->from, &datagram);
        if (whole) {
            take(user, whole->channel, whole->bytes, whole->filled);
        }
    }
}

int ale_udpm_receive(ale_udpm_t *udpm, ale_lcm_take_t take, void *user)
{
    struct sockaddr_in from = {0};
    _Alignas(struct cmsghdr) uint8_t control[CONTROL_BYTES];
    struct iovec room = {udpm->buffers->datagram, sizeof udpm->buffers->datagram};
    struct msghdr message = {.msg_name = &from,
                             .msg_namelen = sizeof from,
                             .msg_iov = &room,
                             .msg_iovlen = 1,
                             .msg_control = control,
                             .msg_controllen = sizeof control};
    const ssize_t count = recvmsg(udpm->in, &message, 0);
    if (count < 0) {
        return errno == EAGAIN || errno == EINTR ? 0 : -1;
    }
    note_unheard(udpm, &message);
    udpm->from = (uint64_t)from.sin_addr.s_addr << 16 | from.sin_port;
    take_datagram(udpm, (size_t)count, take, user);
    return 1;
}

uint64_t ale_udpm_sender(const ale_udpm_t *udpm)
{
    return udpm->from;
}

ale_lcm_dropped_t ale_udpm_dropped(const ale_udpm_t *udpm)
{
    const uint64_t parts = udpm->buffers ? udpm->buffers->assembly.refused : 0;
    return (ale_lcm_dropped_t){.malformed = udpm->malformed + parts,
                               .unheard = udpm->unheard_before + udpm->unheard};
}
