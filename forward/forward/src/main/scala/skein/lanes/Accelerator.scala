package skein.lanes

import skein.forward.{LoopTiming, VelocityResponse}

/** Simulates candidates through shared episodes in place of this machine's processors, as a GPU does.
  * Outcomes are identical, to the bit.
  */
trait Accelerator:
  /** The engine, with the number of candidates of some episodes that keeps it busy. */
  def engine: Engine

  /** Prepares teams.
    *
    * @param threads that prepare flights
    * @return Left states why it does not support such teams
    */
  private[lanes] def teams(
      timing: LoopTiming,
      response: VelocityResponse,
      threads: Int,
      episodes: Episodes
  ): Either[String, AcceleratedTeams]

private[lanes] object Accelerator:
  /** The engine that replaces SIMD, or why none does; None where no accelerator was requested.
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

/** Teams on an accelerator; one call at a time, not thread-safe. */
private[lanes] trait AcceleratedTeams:
  /** Simulates the candidates that are formulas, unless it is cancelled.
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

/** The result of an accelerator's call.
  *
  * @param flown number of worlds that were simulated
  * @param left the worlds of candidates that are not formulas
  */
private[lanes] final case class Accelerated(flown: Int, left: Array[Int])

private[lanes] object Accelerated:
  /** Lets an accelerator simulate its worlds before the processors do: none, unless they are candidates that
    * share their episodes.
    *
    * @param flights see [[Accelerator.instead]]
    */
  def first[F](flights: Option[Either[String, F]], worlds: Worlds)(
      fly: F => Accelerated
  ): Accelerated =
    flights
      .flatMap(_.toOption)
      .filter(_ => worlds.shareEpisodes && worlds.episodesOfEach > 0)
      .fold(Accelerated(0, Array.range(0, worlds.size)))(fly)
