package skein.lanes

import skein.forward.{LoopTiming, VelocityResponse}

/** Simulates candidates that share their episodes in place of this machine's processors, for example a GPU.
  * Outcomes are identical, to the bit.
  */
trait Accelerator:
  /** The engine; its `sideBySide` is the number of candidates that keeps the accelerator busy. */
  def engine: Engine

  /** Prepares teams.
    *
    * @param threads number of threads that prepare the simulation
    * @return Left says why the accelerator does not support such teams
    */
  private[lanes] def teams(
      timing: LoopTiming,
      response: VelocityResponse,
      threads: Int,
      episodes: Episodes
  ): Either[String, AcceleratedTeams]

/** Teams prepared for an accelerator. Not thread-safe: one call at a time. */
private[lanes] trait AcceleratedTeams:
  /** Simulates the candidates that are formulas, unless it is cancelled.
    *
    * @param worlds worlds with a positive [[Worlds.episodesOfEach]]
    * @param prepared yields the candidate of a world
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
  * @param left the other worlds, whose candidates are not formulas
  */
private[lanes] final case class Accelerated(flown: Int, left: Array[Int])
