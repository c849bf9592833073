// A motor controller for ALE-SLAM on an Arduino. Beside this file: receiver.c and receiver.h, or line_receiver.c and
// line_receiver.h (#include "receiver.h" in the .c). Choose one way to the robot:
//   LINE 1  the serial line ([drive] port = ...): any board
//   LINE 0  LCM by Ethernet or Wi-Fi ([drive] key = ...): a board with a network; here an ESP32
#define LINE 1

#if LINE
#include "line_receiver.h"
ale_motor_line_t line;
#else
#include <WiFi.h>
#include <WiFiUdp.h>
#include "receiver.h"
const uint8_t KEY[ALE_MOTOR_KEY] = {0};  // the 64 digits of drive.key, as 0x3f, 0x09 ...; zeros: nothing is obeyed
const IPAddress GROUP(239, 255, 76, 67);
const uint16_t PORT = 7667;
WiFiUDP udp;
ale_motor_t motor;
uint32_t ready_ms, sequence;

// One message of LCM: "LC02", its number, the channel with its end, the bytes.
void publish_ready() {
  static const char channel[] = "ALE_DRIVE_READY";
  uint8_t bytes[ALE_MOTOR_READY];
  size_t count = ale_motor_ready(&motor, bytes);
  uint8_t head[8] = {'L', 'C', '0', '2', uint8_t(sequence >> 24), uint8_t(sequence >> 16), uint8_t(sequence >> 8), uint8_t(sequence)};
  sequence++;
  udp.beginMulticastPacket();
  udp.write(head, sizeof head);
  udp.write((const uint8_t *)channel, sizeof channel);
  udp.write(bytes, count);
  udp.endPacket();
}

void receive() {
  static const char channel[] = "ALE_DRIVE_KEYED";
  const size_t begin = 8 + sizeof channel;
  uint8_t packet[8 + sizeof channel + ALE_MOTOR_MESSAGE];
  while (udp.parsePacket() > 0) {
    size_t count = udp.read(packet, sizeof packet);
    if (count == sizeof packet && memcmp(packet, "LC02", 4) == 0 && memcmp(packet + 8, channel, sizeof channel) == 0)
      ale_motor_take(&motor, packet + begin, ALE_MOTOR_MESSAGE, millis());
  }
}
#endif

// What your wheels need: here both speeds, in mm/s, of a robot with 160 mm between its wheels.
void drive(long v_mm_s, long w_mrad_s) {
  long half_turn = w_mrad_s * 80 / 1000;
  set_wheels(v_mm_s - half_turn, v_mm_s + half_turn);
}

void set_wheels(long left_mm_s, long right_mm_s) {
  (void)left_mm_s, (void)right_mm_s;  // your motor driver
}

void setup() {
#if LINE
  Serial.begin(115200);
#else
  WiFi.begin("network", "password");
  while (WiFi.status() != WL_CONNECTED) delay(100);
  memcpy(motor.key, KEY, sizeof motor.key);
  motor.next = (uint64_t)esp_random() << 32 | esp_random() | 1;  // of true random numbers: the radio is on
  udp.beginMulticast(GROUP, PORT);
#endif
}

void loop() {
  int32_t v, w;
#if LINE
  while (Serial.available()) ale_motor_byte(&line, (char)Serial.read(), millis());
  ale_motor_line_set_point(&line, millis(), &v, &w);
  drive(v, w);
#else
  receive();
  if (millis() - ready_ms >= 500) {
    publish_ready();
    ready_ms = millis();
  }
  ale_motor_set_point(&motor, millis(), &v, &w);
  drive(v / 1000, w / 1000);
#endif
}
