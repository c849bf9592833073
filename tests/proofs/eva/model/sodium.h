/* libsodium's contracts, as its manual has them: what it reads and writes. */
#ifndef ALE_PROOFS_EVA_SODIUM_H
#define ALE_PROOFS_EVA_SODIUM_H

#include <stddef.h>

#define crypto_sign_BYTES 64U
#define crypto_sign_PUBLICKEYBYTES 32U
#define crypto_sign_SECRETKEYBYTES 64U

/*@ requires \valid_read(signature + (0 .. 63)) && \valid_read(key + (0 .. 31));
  @ requires bytes == 0 || \valid_read(message + (0 .. bytes - 1));
  @ assigns \result \from signature[0 .. 63], message[0 .. bytes - 1], key[0 .. 31]; */
int crypto_sign_verify_detached(const unsigned char *signature, const unsigned char *message,
                                unsigned long long bytes, const unsigned char *key);

/*@ requires \valid(signature + (0 .. 63)) && \valid_read(key + (0 .. 63));
  @ requires bytes == 0 || \valid_read(message + (0 .. bytes - 1));
  @ assigns signature[0 .. 63], \result \from message[0 .. bytes - 1], key[0 .. 63];
  @ ensures \initialized(signature + (0 .. 63)); */
int crypto_sign_detached(unsigned char *signature, unsigned long long *signature_bytes,
                         const unsigned char *message, unsigned long long bytes, const unsigned char *key);

/*@ requires \valid(hash + (0 .. hash_bytes - 1));
  @ requires bytes == 0 || \valid_read(message + (0 .. bytes - 1));
  @ assigns hash[0 .. hash_bytes - 1], \result \from message[0 .. bytes - 1];
  @ ensures \initialized(hash + (0 .. hash_bytes - 1)); */
int crypto_generichash(unsigned char *hash, size_t hash_bytes, const unsigned char *message,
                       unsigned long long bytes, const unsigned char *key, size_t key_bytes);

#endif
