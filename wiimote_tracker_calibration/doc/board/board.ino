// The board of 16 LEDs, for an Arduino: see ../board.md. Pin kRows[r] switches the supply of row r,
// kColumns[c] the return of column c (transistor to ground), both on when high.

const byte kRows[4] = {2, 3, 4, 5};
const byte kColumns[4] = {6, 7, 8, 9};
const unsigned long kStepMicros = 60000, kFlashMicros = 40000;
const byte kSteps = 33;
unsigned long step_start;
byte step = 0;

void light(byte rows, byte columns) {  // bit i: line i
  for (byte i = 0; i < 4; ++i) {
    digitalWrite(kRows[i], rows >> i & 1);
    digitalWrite(kColumns[i], columns >> i & 1);
  }
}

void setup() {
  for (byte i = 0; i < 4; ++i) {
    pinMode(kRows[i], OUTPUT);
    pinMode(kColumns[i], OUTPUT);
  }
  step_start = micros();
}

void loop() {
  if (step < 4)
    light(1 << step, 15);
  else if (step % 4 == 0 && step <= 16)
    light(15, 1 << (step / 4 - 1));
  while (micros() - step_start < kFlashMicros) {}
  light(0, 0);
  while (micros() - step_start < kStepMicros) {}
  step_start += kStepMicros;
  step = (step + 1) % kSteps;
}
