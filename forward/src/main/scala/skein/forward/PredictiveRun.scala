package skein.forward

import skein.forecast.{Commanded, Evidence, Forecast}
import skein.signal.Stamped
import skein.units.Instant
import skein.vehicle.Setpoint

/** [[LoopTiming.Predictive]]. The forecast is a value: this loop allocates. */
private[skein] final class PredictiveRun(timing: LoopTiming.Predictive, world: DuelWorld)
    extends LoopRun,
      PeriodicQuestions.Seen:

  private val periodNs  = Nanos.of(timing.periodS)
  private val questions =
    Array.tabulate(world.count)(PeriodicQuestions(world, _, periodNs, timing.asking, this))
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = false, this))

  private val sight               = DuelObservation(world.count)
  private val validAt, receivedAt = Array.ofDim[Long](world.count)
  private val known               = Array.ofDim[Boolean](world.count)
  private var forecast            = Forecast(Vector.empty)

  def start(): Unit =
    java.util.Arrays.fill(known, false)
    forecast = Forecast(Vector.fill(world.count)(timing.predictor))
    questions.foreach(_.start())
    world.schedule(periodNs / 2, DuelWorld.Due, 0, 0)

  def tick(vehicle: Int, number: Int): Unit = questions(vehicle).tick(number)

  def answered(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = true)

  def timedOut(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = false)

  def seen(vehicle: Int, question: Int): Unit =
    val at      = world.slot(vehicle, question)
    val isNewer =
      !known(vehicle) || world.validAtNs(at) > validAt(vehicle) || world.sentAtNs(at) > receivedAt(vehicle)
    if isNewer then
      known(vehicle) = true
      validAt(vehicle) = world.validAtNs(at); receivedAt(vehicle) = world.receivedAtNs(at)
      val reading = Stamped(
        world.seen(vehicle, question),
        Instant.ofNanos(world.validAtNs(at)),
        Instant.ofNanos(world.sentAtNs(at)),
        Instant.ofNanos(world.receivedAtNs(at))
      )
      val before = forecast.tracks(vehicle)
      forecast = forecast.withEvidence(Evidence.Seen(vehicle, reading))
      if before.forall(reading.validAt > _.newest.validAt) then
        world.observer.entered(
          vehicle,
          question,
          reading.validAt.toNanos,
          before.fold(Vector.empty)(_.legsTo(reading.validAt, forecast.delays.get, reading.receivedAt))
        )

  override def due(number: Int): Unit =
    world.schedule(periodNs / 2 + (number + 1) * periodNs, DuelWorld.Due, 0, number + 1)
    if !known.contains(false) then
      sight.takeSent(controllers)
      System.arraycopy(validAt, 0, sight.validAtNs, 0, world.count)
      java.util.Arrays.fill(sight.step, number)
      sight.forecast = Some(forecast)
      for controller <- controllers do controller.offer(sight)

  override def sent(agent: Int, number: Int, headingRad: Double, speedMps: Double): Unit =
    val setpoint = Setpoint.velocityZ(
      speedMps * StrictMath.cos(headingRad),
      speedMps * StrictMath.sin(headingRad),
      world.agents(agent).altitudeDownM
    )
    forecast = forecast.withEvidence(
      Evidence.Sent(agent, Commanded(number, setpoint, Instant.ofNanos(world.nowNs)))
    )

  override def replaced(agent: Int, number: Int): Unit =
    forecast = forecast.withEvidence(Evidence.Replaced(agent, number, Instant.ofNanos(world.nowNs)))
