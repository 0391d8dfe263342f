package skein.simulator

import skein.units.Span

/** PX4's interface in lockstep, in virtual time: its speed relative to the clock, and whether three flights
  * are identical to the last byte. `bench/hil/gaps.c` measures it by the clock.
  */
@main def hilLockstep(seconds: Int): Unit =
  def round(value: Double) = math.round(value * 100) / 100.0
  val flights              = Vector.fill(3)(HilFlightSimulation.fly(1, Span.ofSeconds(seconds), speed = 1))
  for flight <- flights do
    println(
      s"$seconds s simulated in ${round(flight.seconds)} s: ${round(seconds / flight.seconds)} times " +
        s"real time; ${flight.sensors} HIL_SENSOR; at ${flight.positionNed}; ${flight.digest}"
    )
  println(if flights.map(_.digest).distinct.size == 1 then "digests are equal" else "DIGESTS DIFFER")
