package skein.observe

import skein.units.{Instant, Span}

/** Sums up the commands to one vehicle. Mutable. */
private[observe] final class VehicleAccount(val name: String):
  import VehicleAccount.PhysicsStep

  private val ownAge      = Samples()
  private val othersAge   = Samples()
  private val bound       = Samples()
  private val every       = Samples()
  private val sinceOthers = Samples()
  private val skew        = Samples()
  private var superseded  = 0L

  var commands     = 0L
  var commandedAt  = Option.empty[Instant]
  var overtaken    = 0L
  var mostInFlight = 0
  var joined       = 0L
  var leftRunning  = 0L

  /** Adds a command.
    *
    * @param agesMs of the newest reading of each vehicle
    */
  def add(command: ObservedCommand, at: Instant, agesMs: Iterable[Double]): Unit =
    commands += 1
    commandedAt = Some(at)
    command.sinceOwnMs.foreach(every.add)
    if command.sinceOwnMs.exists(_ < PhysicsStep.toMillis) then superseded += 1
    command.sinceOthersMs.foreach(sinceOthers.add)
    command.ownAgeMs.foreach(ownAge.add)
    command.othersAgeMs.foreach(othersAge.add)
    command.boundMs.foreach(bound.add)
    if agesMs.sizeIs > 1 then skew.add(agesMs.max - agesMs.min)

  /** Mean age of the own data behind a command, ms. */
  def ownAgeMs: Option[Double] = ownAge.mean

  def observed: ObservedVehicle = ObservedVehicle(
    name,
    commands,
    ownAge.distribution,
    othersAge.distribution,
    bound.mean,
    every.distribution,
    sinceOthers.distribution,
    skew.distribution,
    superseded,
    overtaken,
    mostInFlight,
    joined,
    leftRunning
  )

private[observe] object VehicleAccount:

  /** The progress of an observation of these vehicles. */
  def progress(lasted: Span, vehicles: Iterator[VehicleAccount]): Progress =
    val all = vehicles.toVector
    Progress(
      lasted,
      all.map(_.commands).sum,
      all.flatMap(one => one.ownAgeMs.map(ms => (vehicle = one.name, ms = ms)))
    )

  /** AirSim's physics step: a command replaced within it never takes effect. */
  private val PhysicsStep = Span.ofMillis(3)
