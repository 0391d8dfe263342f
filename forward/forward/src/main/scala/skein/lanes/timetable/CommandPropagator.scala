package skein.lanes.timetable

import skein.units.Span

/** Which command acts when, as [[PlantModel]] takes it: each a dead time after it has come. A command that
  * repeats the one before is a new one here, and nothing there: with drag a piece more begins.
  *
  * @param propagation of what is flown, and until when, s from the reading
  */
private[lanes] final class CommandPropagator private (
    deadTime: Span,
    propagation: (Vector[CommandPropagator.Flown], Double) => Propagation,
    held: CommandPropagator.Known
) extends Propagator:
  import CommandPropagator.*

  def next(legs: Vector[Propagator.Leg]): Propagator =
    new CommandPropagator(deadTime, propagation, legs.foldLeft(held)(_.through(_, deadTime)._2))

  def predicted(legs: Vector[Propagator.Leg]): Propagation =
    val flown  = Vector.newBuilder[Flown]
    var known  = held
    var startS = 0.0
    for leg <- legs do
      val (due, after)        = known.through(leg, deadTime)
      val endS                = startS + leg.span.toSeconds
      var acting              = known.acting
      var fromS               = startS
      def fly(untilS: Double) = if untilS > fromS then flown += Flown(acting, fromS, untilS)
      for (decision, in) <- due do
        val actsS = startS + in.toSeconds
        fly(actsS)
        acting = decision
        fromS = actsS
      fly(endS)
      known = after
      startS = endS
    propagation(flown.result(), startS)

private[lanes] object CommandPropagator:
  def apply(deadTimeS: Double, propagation: (Vector[Flown], Double) => Propagation): Propagator =
    new CommandPropagator(Span.ofSeconds(deadTimeS), propagation, Known(0, 0, Vector.empty))

  /** Under which decision's command the model flies from when until when, s from the reading. */
  final case class Flown(decision: Int, fromS: Double, untilS: Double)

  /** Of what is flown, with so many numbers of each part, which are put into an array from an index on. */
  def told(flown: Vector[Flown], perPart: Int, first: Double = 0, second: Double = 0)(
      tell: (Flown, Array[Float], Int) => Unit
  ): Propagation =
    val numbers = Array.ofDim[Float](flown.size * perPart)
    for (part, i) <- flown.zipWithIndex do tell(part, numbers, i * perPart)
    Propagation(flown.map(_.decision).toArray, numbers, first.toFloat, second.toFloat)

  /** What [[PlantModel.Flying]] knows of commands, by their decisions.
    *
    * @param coming and in how long each acts
    */
  final case class Known(acting: Int, last: Int, coming: Vector[(Int, Span)]):
    /** What acts within a leg, and in how long, and what is known behind it. Whoever came first acts first.
      */
    def through(leg: Propagator.Leg, deadTime: Span): (Vector[(Int, Span)], Known) =
      val now            = if leg.decision == last then coming else coming :+ (leg.decision, deadTime)
      val (due, waiting) = now.span(_._2 <= leg.span)
      val behind         = waiting.map((decision, in) => (decision, in - leg.span))
      (due, Known(due.lastOption.fold(acting)(_._1), leg.decision, behind))
