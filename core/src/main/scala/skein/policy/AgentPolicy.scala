package skein.policy

import skein.units.*

/** How a vehicle decides: a pure function from what it observes, and a memory of its own, to an action and the next
  * memory. It integrates over measured time ([[Observation.elapsed]]) and never counts its calls: deciding twice as often
  * must not act twice as strongly. Nothing else is remembered between decisions, so that a recorded flight is decided
  * again from the recording alone.
  */
trait AgentPolicy:

  /** What it remembers from one decision to the next. Immutable. */
  type Memory

  /** Which sensors of its vehicle it wants to be read, by name; see [[skein.port.VehiclePort.sensors]]. What they said
    * last is in [[Observation.sensed]].
    */
  def sensors: Set[String] = Set.empty

  /** Before the first decision. */
  def start: Memory

  /** What to do now, and what to remember. */
  def choose(seen: Observation, memory: Memory): (Action, Memory)

/** A policy that steers in the plane, at the altitude of its vehicle's start: a convenience on top of [[AgentPolicy]]. */
trait PlanarPolicy extends AgentPolicy:

  /** Where to fly, and what to remember. */
  def planar(seen: Observation, memory: Memory): (Planar, Memory)

  final def choose(seen: Observation, memory: Memory): (Action, Memory) =
    val (chosen, next) = planar(seen, memory)
    (Action.heading(chosen.heading, chosen.speed.getOrElse(seen.cruise), seen.altitude), next)

/** A horizontal velocity to command.
  *
  * @param heading
  *   any number of turns
  * @param speed
  *   absent: the vehicle's own
  */
final case class Planar(heading: Radians, speed: Option[MetresPerSecond])
