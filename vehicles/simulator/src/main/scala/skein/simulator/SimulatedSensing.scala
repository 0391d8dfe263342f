package skein.simulator

import skein.signal.{Kinematics, SplitMix64}
import skein.units.{Instant, Span, Vector3}
import skein.vehicle.{NoisySensor, SensorNoise}

/** What the simulator reports of its vehicles' motion.
  *
  * @param seed of all errors; each vehicle has errors of its own
  * @param truth receives every vehicle's true position every 50 ms of simulated time
  * @param isOn whether there are errors by now; until then readings are true, and nothing receives the truth
  */
final case class SimulatedSensing(
    noise: SensorNoise,
    seed: Long = 1,
    truth: TruePosition => Unit = _ => (),
    isOn: () => Boolean = () => true
):
  private[simulator] def sensor(vehicle: Int): NoisySensor =
    NoisySensor(noise, SplitMix64.seedOf(seed, vehicle))

object SimulatedSensing:
  private[simulator] val TruthEvery: Span = Span.ofMillis(50)

/** @param at the instant that it shows, on the simulator's clock
  * @param sinceStart time since the simulation's start, as MAVLink's vehicles count it
  * @param positionNed world NED, m
  */
final case class TruePosition(vehicle: String, at: Instant, sinceStart: Span, positionNed: Vector3)

/** A reading of a vehicle's motion, in its own frame, or its true motion.
  *
  * @param at the instant that it shows
  * @param isMissing whether the sensors have no reading now, so that this one is an earlier one
  */
private[simulator] final case class Sensed(
    motion: Kinematics,
    accelerationNed: Vector3,
    angularAccelerationFrd: Vector3,
    at: Instant,
    isMissing: Boolean = false
)
