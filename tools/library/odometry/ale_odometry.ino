// Counts two encoders and says so 50 times a second, for ale-odometry on the robot's computer:
//   $TICKS,LEFT,RIGHT,MICROS*CRC
// Each encoder has two wires; A must be on a pin that can interrupt.
const int LEFT_A = 2, LEFT_B = 4, RIGHT_A = 3, RIGHT_B = 5;
volatile long left, right;

// B tells the direction. Counts the wrong way: swap A and B, or give ale-odometry a negative --left or --right.
void count_left() { left += digitalRead(LEFT_B) ? -1 : 1; }
void count_right() { right += digitalRead(RIGHT_B) ? -1 : 1; }

unsigned crc_of(const char *text) {  // CRC-16/CCITT-FALSE
  unsigned long sum = 0xFFFF;
  for (; *text; text++) {
    sum ^= (unsigned long)(unsigned char)*text << 8;
    for (int bit = 0; bit < 8; bit++) sum = (sum & 0x8000 ? (sum << 1) ^ 0x1021 : sum << 1) & 0xFFFF;
  }
  return (unsigned)sum;
}

void setup() {
  Serial.begin(115200);
  const int pins[] = {LEFT_A, LEFT_B, RIGHT_A, RIGHT_B};
  for (int pin : pins) pinMode(pin, INPUT_PULLUP);
  attachInterrupt(digitalPinToInterrupt(LEFT_A), count_left, RISING);
  attachInterrupt(digitalPinToInterrupt(RIGHT_A), count_right, RISING);
}

void loop() {
  static unsigned long said;
  if (micros() - said < 20000) return;
  said = micros();
  noInterrupts();  // all of one instant
  long l = left, r = right;
  unsigned long now = micros();
  interrupts();
  char text[48], sum[8];
  snprintf(text, sizeof text, "TICKS,%ld,%ld,%lu", l, r, now);
  snprintf(sum, sizeof sum, "*%04X\r\n", crc_of(text));
  Serial.print('$');
  Serial.print(text);
  Serial.print(sum);
}
