package skein.lanes.gpu

import skein.forward.Duel
import skein.gpu.{Gpu, Ptx, PtxExpressions, Variables}
import skein.lanes.{DuelKernel, DuelNumber}
import skein.lanes.policy.PolicyLanes
import skein.lanes.score.ScoreLanes
import skein.lanes.timetable.Timetable
import skein.policy.HeadingPolicy

/** Duels on a GPU: the evader is vehicle 0, and the first side.
  *
  * @param duel start, speeds and duration
  */
private[lanes] final class GpuDuelKernel(
    gpu: Gpu,
    duel: Duel,
    periodS: Double,
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    forms: Vector[PolicyLanes],
    asked: Set[DuelNumber],
    layout: GpuLayout
) extends GpuFlightKernel(
      gpu,
      layout,
      forms.map(form => form.parameters + form.memories),
      ScoreLanes.ofDistance(DuelKernel.judged(duel.durationS, periodS, asked).map(_._2)*)
    ):
  private val agents  = Vector(duel.evader, duel.pursuer)
  private val judged  = DuelKernel.judged(duel.durationS, periodS, asked)
  private val efforts = Vector(DuelNumber.EvaderEffort, DuelNumber.PursuerEffort).map(asked)

  val outcomes: Int = scores.initial.size + efforts.count(identity)

  protected val withVelocity: Boolean = forms.exists(_.needsVelocity)

  /** The numbers of one policy: its parameters, then its initial memory. */
  def numbersOf(side: Int, policy: HeadingPolicy): Array[Float] =
    (forms(side).parametersOf(policy) ++ forms(side).initialOf(policy)).map(_.toFloat)

  /** Index of a number among a world's results, and its conversion. */
  def outcome(number: DuelNumber, scoredAtS: Array[Float]): (Int, Float => Float) = number match
    case DuelNumber.EvaderEffort  => (scores.initial.size, identity)
    case DuelNumber.PursuerEffort => (outcomes - 1, identity)
    case _                        =>
      val outcome = GpuFlightKernel.Outcome(scores, judged.indexWhere(_._1 == number), scoredAtS)
      (outcome.place, outcome(_))

  protected def body(code: Ptx, numbers: Vector[Int => Int]): Body = new Body:
    val vehicles: Vector[GpuVehicle] = agents.map: agent =>
      vehicle(code, agent, code.constant(agent.startX.toFloat), code.constant(agent.startY.toFloat))
    val predictions: Vector[GpuPrediction] = prediction.toVector.flatMap(of => agents.map(of(code, _)))
    private val effort                     = Vector.fill(2)(Variables(code, Seq(0f)))
    private val heading = agents.map(each => Variables(code, Seq(each.startHeadingRad.toFloat)))
    private val memory  = forms.map(form => Variables(code, Seq.fill(form.memories)(0f)))
    private val radius  = code.argument("limit")

    def start(): Unit = for self <- 0 to 1 do
      effort(self).start()
      heading(self).start()
      memory(self).take(Vector.tabulate(forms(self).memories)(i => numbers(self)(forms(self).parameters + i)))
      // The timetable keeps the first heading at place 0.
      val at         = code.own(code.whole(layout.heading(self, 0)))
      val headingRad = agents(self).startHeadingRad.toFloat.toDouble
      code.storeOwn(code.constant(StrictMath.cos(headingRad).toFloat), at, 0)
      code.storeOwn(code.constant(StrictMath.sin(headingRad).toFloat), at, 1)

    def show(now: GpuRecord): Unit = ()

    def decide(self: Int, now: GpuRecord): Unit =
      import PolicyLanes.In
      val form                         = forms(self)
      val seen                         = now.seen()
      val (own, opponent)              = (seen(self), seen(1 - self))
      val Vector(known, before, after) = Vector(2, 3, 4).map(now.place): @unchecked
      val decided                      = PtxExpressions.write(code, form.nodes(efforts(self)))(
        {
          case read if read < Timetable.Read =>
            code.two("sub.rn", code.loadOwn(opponent, read), code.loadOwn(own, read))
          case In.Elapsed     => now.time(0)
          case In.OwnCos      => code.loadOwn(before, 0)
          case In.OwnSin      => code.loadOwn(before, 1)
          case In.KnownCos    => code.loadOwn(known, 0)
          case In.KnownSin    => code.loadOwn(known, 1)
          case In.Heading     => heading(self)(0)
          case In.OwnAge      => now.time(1)
          case In.OpponentAge => now.time(2)
          case remembered     => memory(self)(remembered - In.Memory)
        },
        numbers(self)
      )
      code.storeOwn(decided(0), after, 0)
      code.storeOwn(decided(1), after, 1)
      if efforts(self) then effort(self).take(Seq(code.two("add.rn", effort(self)(0), decided(2))))
      val first = form.decided - (if efforts(self) then 0 else 1)
      memory(self).take(decided.slice(first, first + form.memories))
      if form.keepsHeading then heading(self).take(Seq(decided(first + form.memories)))

    def altitude(vehicle: Int): Int                = code.constant(agents(vehicle).altitudeDownM.toFloat)
    def quantity(number: Int, parameter: Int): Int =
      throw IllegalStateException("a distance has no parameters")
    def limit(number: Int): Int = radius
    def besides: Vector[Int]    = Vector(0, 1).filter(efforts).map(effort(_)(0))
