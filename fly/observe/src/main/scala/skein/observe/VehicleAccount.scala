package skein.observe

import skein.units.{Instant, Span}

/** Sums up the commands to one vehicle. Mutable. */
private[observe] final class VehicleAccount(val name: String):
  import VehicleAccount.{Ages, PhysicsStep}

  private val aligned, early = Ages()
  private val every          = Samples()
  private val sinceOthers    = Samples()
  private var superseded     = 0L
  private var worst          = Option.empty[NewCommands]

  var commands     = 0L
  var commandedAt  = Option.empty[Instant]
  var overtaken    = 0L
  var mostInFlight = 0
  var joined       = 0L
  var leftRunning  = 0L

  /** Adds a command.
    *
    * @param agesMs age of the newest reading of each vehicle
    * @param isEarly whether a clock behind the ages was not compared with ours: see [[ObservedVehicle.early]]
    */
  def add(command: ObservedCommand, at: Instant, agesMs: Iterable[Double], isEarly: Boolean = false): Unit =
    commands += 1
    commandedAt = Some(at)
    command.sinceOwnMs.foreach(every.add)
    if command.sinceOwnMs.exists(_ < PhysicsStep.toMillis) then superseded += 1
    command.sinceOthersMs.foreach(sinceOthers.add)
    (if isEarly then early else aligned).add(command, agesMs)
    worst = Some(worst.fold(NewCommands.of(command))(_.worst(NewCommands.of(command))))

  /** Commands since the last call; None without any. */
  def takeNew(): Option[NewCommands] =
    val taken = worst
    worst = None
    taken

  /** Mean age of the vehicle's own data behind a command, ms. */
  def ownAgeMs: Option[Double] = known.own.mean

  private def known = if aligned.isEmpty then early else aligned

  def observed: ObservedVehicle = ObservedVehicle(
    name,
    commands,
    known.own.distribution,
    known.others.distribution,
    known.bound.mean,
    every.distribution,
    sinceOthers.distribution,
    known.skew.distribution,
    if aligned.isEmpty then 0 else early.commands,
    superseded,
    overtaken,
    mostInFlight,
    joined,
    leftRunning
  )

private[observe] object VehicleAccount:
  private final class Ages:
    val own, others, bound, skew = Samples()
    var commands                 = 0L

    def isEmpty: Boolean = commands == 0

    def add(command: ObservedCommand, agesMs: Iterable[Double]): Unit =
      if agesMs.nonEmpty then commands += 1
      command.ownAgeMs.foreach(own.add)
      command.othersAgeMs.foreach(others.add)
      command.boundMs.foreach(bound.add)
      if agesMs.sizeIs > 1 then skew.add(agesMs.max - agesMs.min)

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
