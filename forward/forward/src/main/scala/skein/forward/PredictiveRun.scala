package skein.forward

import skein.forecast.{Commanded, ForecastEvent, Forecast}
import skein.policy.{Action, ActionGuidance}
import skein.signal.Stamped
import skein.units.Instant

/** The loop [[LoopTiming.Predictive]] in virtual time. The forecast is an immutable value: this loop
  * allocates.
  */
private[skein] final class PredictiveRun(timing: LoopTiming.Predictive, world: RolloutWorld)
    extends AskingRun(world, timing.periodS, timing.asking):

  private val periodNs               = Nanos.of(timing.periodS)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = false, this))

  private val observation = RolloutView(world)
  private var forecast    = Forecast(Vector.empty)

  override def start(): Unit =
    forecast = Forecast(world.responses.map(_.predictorUnder(timing.predictor)))
    super.start()
    world.schedule(periodNs / 2, RolloutWorld.Due, 0, 0)

  protected def renewed(vehicle: Int, question: Int): Unit =
    observation.reading(vehicle) = question
    val at      = world.slot(vehicle, question)
    val reading = Stamped(
      world.seen(vehicle, question),
      Instant.ofNanos(world.validAtNs(at)),
      Instant.ofNanos(world.sentAtNs(at)),
      Instant.ofNanos(world.receivedAtNs(at))
    )
    val before = forecast.tracks(vehicle)
    forecast = forecast.withEvent(ForecastEvent.Seen(vehicle, reading))
    if before.forall(reading.validAt > _.newest.validAt) then
      world.observer.entered(
        vehicle,
        question,
        world.nowNs,
        reading.validAt.toNanos,
        before.fold(Vector.empty)(_.legsTo(reading.validAt, forecast.delays.get, reading.receivedAt))
      )

  override def due(number: Int): Unit =
    world.schedule(periodNs / 2 + (number + 1) * periodNs, RolloutWorld.Due, 0, number + 1)
    if !known.contains(false) then
      observation.takeSent(controllers)
      System.arraycopy(validAt, 0, observation.validAtNs, 0, world.count)
      java.util.Arrays.fill(observation.step, number)
      observation.forecast = Some(forecast)
      for controller <- controllers do controller.offer(observation)

  override def sent(agent: Int, number: Int, action: Action): Unit =
    val command = Commanded(number, ActionGuidance.of(action), Instant.ofNanos(world.nowNs))
    forecast = forecast.withEvent(ForecastEvent.Sent(agent, command))

  override def replaced(agent: Int, number: Int): Unit =
    forecast = forecast.withEvent(ForecastEvent.Replaced(agent, number, Instant.ofNanos(world.nowNs)))
