package skein.simulator

import scala.collection.mutable
import skein.units.*

/** Lets the simulator's clock wait for commands with stamps of it. From the first on, it stops every `step`
  * until each vehicle that was commanded has a command stamped then or later. Commands act at stops, so
  * neither the machine's load nor the clock's speed changes the flight. At the first stop it stands for
  * [[CommandLockstep.Settling]] of real time, in which nodes handle the messages that queued while it ran.
  *
  * A command stamped before another of its vehicle, by whichever topic, is left out: it is late.
  *
  * If none arrives within [[CommandLockstep.Patience]] of real time, it stops waiting until the next command.
  *
  * @param physics the step of physics, of which the first stop is a whole number after the start
  * @param now the simulator's clock, now at its start
  */
private[simulator] final class CommandLockstep(step: Span, physics: Span, now: () => Instant)
    extends Lockstep:
  import CommandLockstep.*

  private val startedAt = now()
  private val newest    = mutable.HashMap.empty[Int, Instant]
  private val kept      = mutable.LinkedHashMap.empty[Int, () => Unit]
  private var next      = Option.empty[Instant]
  private var toldAt    = Option.empty[Instant]
  private var waited    = Span.Zero
  private var abandoned = 0L
  private var overtaken = 0L
  private var isSettled = true

  /** Number of stops at which commands were awaited in vain. */
  def missed: Long = abandoned

  /** Number of commands that were left out, because a later stamp had arrived. */
  def late: Long = overtaken

  /** Receives a command with a stamp of the past; `perform` is called at a stop.
    *
    * @param stamp the command's stamp, on the simulator's clock
    */
  def heard(vehicle: Int, stamp: Instant)(perform: => Unit): Unit =
    if newest.get(vehicle).exists(_ > stamp) then overtaken += 1
    else
      val isStopped = isWaiting
      newest(vehicle) = stamp
      if isStopped then perform else kept(vehicle) = () => perform
      if next.isEmpty then
        next = Some(first)
        isSettled = false
      goOn()

  private def goOn(): Unit =
    if !isWaiting then next = next.map(due => if due <= now() then due + step else due)

  /** The first stop, at which physics has made a whole number of steps. */
  private def first: Instant =
    val (one, other) = (step.toNanos, physics.toNanos)
    val common       = one / BigInt(one).gcd(other).toLong * other
    startedAt + Span.ofNanos((now().since(startedAt).toNanos / common + 1) * common)

  /** Whether the vehicles are seen at this time: between stops they are not. */
  def isSeen(at: Instant): Boolean = next.forall(_ <= at)

  def isWaiting: Boolean =
    next.exists(due => due <= now() && (!isSettled || newest.valuesIterator.exists(_ < due)))

  def stop(until: Instant): Option[Instant] = next.filter(due => due > now() && due <= until)

  def reached(): Unit =
    kept.valuesIterator.foreach(_())
    kept.clear()

  def goal: Option[Instant] = None

  def told(at: Instant): Unit =
    val passed = toldAt.fold(Span.Zero)(at.since(_)).min(LongestLook)
    toldAt = Some(at)
    waited = if isWaiting then waited + passed else Span.Zero
    if waited >= Settling then isSettled = true
    goOn()
    if waited >= Patience then
      abandoned += 1
      newest.clear()
      next = None

private object CommandLockstep:
  val Patience: Span = Span.ofSeconds(1)
  val Settling: Span = Span.ofMillis(500)

  /** The machine may have been stopped meanwhile. */
  private val LongestLook = Span.ofMillis(500)
