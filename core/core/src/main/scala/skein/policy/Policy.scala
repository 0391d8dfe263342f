package skein.policy

/** A vehicle's decision rule: a pure function from observation and memory to action and next memory. It
  * integrates over measured time ([[Observation.elapsed]]) and never counts its calls: deciding twice as
  * often must not act twice as strongly. It keeps nothing else between decisions, so that a replay can repeat
  * them from the recording only.
  */
trait Policy:

  /** The state kept from one decision to the next. Immutable. */
  type Memory

  /** Names of its vehicle's sensors that must be read; see [[skein.port.VehiclePort.sensors]]. Their last
    * readings are in [[Observation.sensed]].
    */
  def sensors: Set[String] = Set.empty

  /** Whether it considers a single opponent and no other vehicle; other policies consider all vehicles. */
  def isAgainstOne: Boolean = false

  /** Whether it guarantees to steer in the plane, at the altitude of its vehicle's start. */
  def isPlanar: Boolean = false

  /** This policy as an opponent with rough knowledge assumes it, for example a planner: its parameters
    * deviate by random numbers. By default it is known exactly.
    *
    * @param draw samples of the standard normal distribution, by index
    */
  def guessed(draw: Int => Double): Policy = this

  /** The memory before the first decision; pure. */
  def start: Memory

  /** Decides: returns the present action, and the memory for the next decision. A pure function. */
  def choose(seen: Observation, memory: Memory): (Action, Memory)

object Policy:

  /** A policy that decides only by the present observation. */
  trait Memoryless extends Policy:
    type Memory = Unit

    final def start: Unit = ()

    /** The present action, as [[Policy.choose]] returns it. */
    def action(seen: Observation): Action

    final def choose(seen: Observation, memory: Unit): (Action, Unit) = (action(seen), ())
