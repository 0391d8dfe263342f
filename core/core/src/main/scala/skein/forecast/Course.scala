package skein.forecast

import scala.annotation.tailrec
import skein.units.*
import skein.vehicle.{Guidance, VehicleModel}

/** A vehicle's predicted state, from which further commands can be simulated.
  *
  * @param at time of the state, on the simulator's clock
  * @param newestAt valid time of the newest reading on which the prediction is based
  */
final class Course[S] private[forecast] (
    model: VehicleModel[S],
    state: S,
    val at: Instant,
    newestAt: Instant
):
  def estimate: Estimate = Estimate(model.kinematics(state), at, newestAt, model.numbers(state))

  /** The course after this time under one command. */
  def flown(guidance: Guidance, span: Span): Course[S] =
    Course(model, Course.guided(model, state, guidance, span), at + span, newestAt)

private object Course:
  def guided[S](model: VehicleModel[S], from: S, guidance: Guidance, span: Span): S =
    val period                                  = guidance.period.getOrElse(span)
    @tailrec def flown(state: S, left: Span): S =
      val part = left.min(period)
      val next = model.advanced(state, guidance.setpoint(model.kinematics(state)), part)
      if part < left then flown(next, left - part) else next
    flown(from, span)
