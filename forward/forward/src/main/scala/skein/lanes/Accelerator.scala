package skein.lanes

import skein.forward.{Delays, LoopTiming, VelocityResponse}
import skein.lanes.timetable.Timetable

/** Flies candidates through shared episodes in place of this machine's processors, as a GPU does. Outcomes
  * are the same, to the bit.
  */
trait Accelerator:
  /** With as many candidates of some episodes as keep it busy. */
  def engine: Engine

  /** @param threads that prepare flights
    * @return or why it flies no such duels
    */
  private[lanes] def duels(
      episodes: DuelEpisodes,
      response: VelocityResponse,
      threads: Int
  ): Either[String, AcceleratedDuels]

  /** @param threads that prepare flights
    * @param timetable of an episode of teams of a form
    * @return or why it flies no such teams
    */
  private[lanes] def teams(
      timing: LoopTiming,
      response: VelocityResponse,
      threads: Int,
      timetable: (Delays, Int, TeamForm) => Timetable
  ): Either[String, AcceleratedTeams]

private[lanes] object Accelerator:
  /** What flies in place of lanes, or why it does not; none where no accelerator was asked for.
    *
    * @param flights that it offers, or why none
    */
  def engine(
      accelerator: Option[Accelerator],
      flights: Option[Either[String, Any]],
      together: Boolean
  ): Option[Either[String, Engine]] =
    for
      by    <- accelerator
      offer <- flights
    yield offer.flatMap: _ =>
      Either.cond(together, by.engine, "the GPU flies candidates that share episodes")

/** Of duels. One call at a time. */
private[lanes] trait AcceleratedDuels:
  /** Flies the candidates whose policies are formulas, unless it is cancelled.
    *
    * @param worlds with [[Worlds.episodesOfEach]]
    */
  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Float,
      into: DuelOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Accelerated

/** Of teams. One call at a time. */
private[lanes] trait AcceleratedTeams:
  /** Flies the candidates that are formulas, unless it is cancelled.
    *
    * @param worlds with [[Worlds.episodesOfEach]]
    * @param prepared a world's candidate
    */
  def fly(
      worlds: TeamWorlds,
      prepared: Int => PreparedTeam,
      into: TeamOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Accelerated

/** What came of a call.
  *
  * @param flown how many worlds were
  * @param left the worlds of candidates that are no formulas
  */
private[lanes] final case class Accelerated(flown: Int, left: Array[Int])

private[lanes] object Accelerated:
  /** What an accelerator flies of worlds before the processors do: nothing, unless they are candidates that
    * fly through the same episodes.
    *
    * @param flights see [[Accelerator.instead]]
    */
  def first[F](flights: Option[Either[String, F]], worlds: Worlds, together: Boolean)(
      fly: F => Accelerated
  ): Accelerated =
    flights
      .flatMap(_.toOption)
      .filter(_ => together && worlds.episodesOfEach > 0)
      .fold(Accelerated(0, Array.range(0, worlds.size)))(fly)
