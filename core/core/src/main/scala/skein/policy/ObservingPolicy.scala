package skein.policy

/** @param memory what the policy is given at its next decision
  */
final case class Decided[M](headingRad: Double, memory: M)

/** A policy with a memory of its own, which also sees the age of each reading. As a [[HeadingPolicy]] it is a
  * pure function.
  *
  * It flies by lanes if [[decide]] is arithmetic and the memory is a number or a case class of numbers.
  *
  * @tparam M what it remembers
  */
trait ObservingPolicy[M] extends HeadingPolicy:

  /** What it remembers before its first decision. */
  def initial: M

  /** The heading to command now, and what to remember. */
  def decide(seen: PlanarObservation, memory: M): Decided[M]

  final override def start: Any = initial

  final override def choose(seen: Observation, memory: Any): (Action, Any) =
    val decided = decide(PlanarObservation.of(seen), memory.asInstanceOf[M])
    (seen.along(decided.headingRad, seen.cruise.value), decided.memory)

  /** As a first decision, on readings of now. */
  final def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double =
    decide(
      PlanarObservation(dxM, dyM, dvxMps, dvyMps, ownHeadingRad, opponentHeadingRad, elapsedS, 0, 0),
      initial
    ).headingRad

object ObservingPolicy:

  /** Decides by a policy of either kind.
    *
    * @param memory the policy's own; anything where it has none
    * @return and what it remembers
    */
  def decide(policy: HeadingPolicy, seen: PlanarObservation, memory: Any): Decided[Any] = policy match
    case observing: ObservingPolicy[m] =>
      val decided = observing.decide(seen, memory.asInstanceOf[m])
      Decided(decided.headingRad, decided.memory)
    case plain => Decided(plain.headingFor(seen), memory)

  /** What a policy remembers before its first decision; nothing where it has no memory. */
  def initialOf(policy: Any): Any = policy match
    case observing: ObservingPolicy[?] => observing.initial
    case _                             => ()
