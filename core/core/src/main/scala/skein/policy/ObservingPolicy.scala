package skein.policy

/** A decision of an [[ObservingPolicy]].
  *
  * @param memory passed to the policy at its next decision
  */
final case class Decided[M](headingRad: Double, memory: M)

/** A policy with memory, which also observes the age of each reading. As a [[HeadingPolicy]] it is a pure
  * function.
  *
  * It is simulated with SIMD if [[decide]] is arithmetic and the memory is a number or a case class of
  * numbers.
  *
  * @tparam M its memory
  */
trait ObservingPolicy[M] extends HeadingPolicy:

  /** The memory before its first decision. */
  def initial: M

  /** The heading to command now, and what to remember. */
  def decide(seen: PlanarObservation, memory: M): Decided[M]

  final override def start: Any = initial

  final override def choose(seen: Observation, memory: Any): (Action, Any) =
    val decided = decide(PlanarObservation.of(seen), memory.asInstanceOf[M])
    (seen.along(decided.headingRad, seen.cruise.value), decided.memory)

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
    * @param memory the policy's own; ignored where it has none
    * @return the heading with the next memory
    */
  def decide(policy: HeadingPolicy, seen: PlanarObservation, memory: Any): Decided[Any] = policy match
    case observing: ObservingPolicy[m] =>
      val decided = observing.decide(seen, memory.asInstanceOf[m])
      Decided(decided.headingRad, decided.memory)
    case plain => Decided(plain.headingFor(seen), memory)

  /** A policy's memory before its first decision; Unit where it has none. */
  def initialOf(policy: Any): Any = policy match
    case observing: ObservingPolicy[?] => observing.initial
    case _                             => ()
