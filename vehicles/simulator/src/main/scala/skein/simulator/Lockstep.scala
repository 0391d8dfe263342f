package skein.simulator

import skein.units.Instant

/** A party for which physics stops at certain times, and may have to wait. */
private[simulator] trait Lockstep:
  def isWaiting: Boolean

  /** The next stop no later than `until`; None if there is none. */
  def stop(until: Instant): Option[Instant]

  /** Is called when physics has reached such a stop. */
  def reached(): Unit

  /** The time to which physics must advance now, whatever the clock shows; None: follow the clock. */
  def goal: Option[Instant]

  /** Receives the current time, by the clock of the simulation's caller. */
  def told(at: Instant): Unit
