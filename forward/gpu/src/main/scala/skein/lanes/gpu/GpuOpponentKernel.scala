package skein.lanes.gpu

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.forward.RolloutAgent
import skein.gpu.{Gpu, Ptx, PtxExpressions, Variables}
import skein.lanes.{PreparedTeam, TeamForm}
import skein.lanes.policy.{OpponentLanes, PolicyLanes, VehicleNumbers}
import skein.lanes.timetable.Timetable

/** Simulates duels on a GPU. Each vehicle is a side: the parameters of its policy, its initial memory, and
  * its start. If quantities have parameters, these are a further side.
  *
  * @param agents the agents of one candidate; other candidates' starts are in their sides
  */
private[lanes] final class GpuOpponentKernel(
    gpu: Gpu,
    agents: Vector[RolloutAgent],
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    form: TeamForm,
    two: OpponentLanes,
    layout: GpuLayout
) extends GpuFlightKernel(
      gpu,
      layout,
      two.forms.map(GpuOpponentKernel.numbers) ++ GpuOpponentKernel.ofScores(form),
      form.scores,
      agents
    ):
  import two.forms

  private val firstStart = forms.map(each => each.parameters + each.memories)

  protected val withVelocity: Boolean = forms.exists(_.needsVelocity)

  def sidesOf(teams: Array[PreparedTeam]): Vector[(Array[Float], Array[Int])] =
    Vector(0, 1).map(side(teams, _)) ++ GpuOpponentKernel.ofScores(form).map: _ =>
      (teams.flatMap(_.ofScores.flatten.map(_.toFloat)), teams.indices.toArray)

  /** Values of one vehicle's side. Nearly always all candidates share the identical agent, and so one set of
    * values.
    */
  private def side(teams: Array[PreparedTeam], self: Int): (Array[Float], Array[Int]) =
    val known    = IdentityHashMap[VehicleNumbers, Integer]()
    val numbers  = mutable.ArrayBuilder.ofFloat()
    val numberOf = teams.map: team =>
      val own    = team.numbers(self)
      val number = known.putIfAbsent(own, known.size)
      if number != null then number.intValue
      else
        numbers ++= own.policy += own.northM += own.eastM
        known.size - 1
    (numbers.result(), numberOf)

  protected def body(code: Ptx, numbers: Vector[Int => Int]): Body = new Body:
    val vehicles: Vector[GpuVehicle] = agents.zipWithIndex.map: (agent, self) =>
      vehicle(code, agent, numbers(self)(firstStart(self)), numbers(self)(firstStart(self) + 1))
    val predictions: Vector[GpuPrediction] = prediction.toVector.flatMap(of => agents.map(of(code, _)))
    private val effort                     = Vector.fill(2)(Variables(code, Seq(0f)))
    private val heading = agents.map(each => Variables(code, Seq(each.startHeadingRad.toFloat)))
    private val memory  = forms.map(form => Variables(code, Seq.fill(form.memories)(0f)))

    def start(): Unit = for self <- 0 to 1 do
      effort(self).start()
      heading(self).start()
      memory(self).take(Vector.tabulate(forms(self).memories)(i => numbers(self)(forms(self).parameters + i)))
      // The timetable keeps the first heading in slot 0.
      val at         = code.own(code.whole(layout.heading(self, 0)))
      val headingRad = agents(self).startHeadingRad.toFloat.toDouble
      code.storeOwn(code.constant(StrictMath.cos(headingRad).toFloat), at, 0)
      code.storeOwn(code.constant(StrictMath.sin(headingRad).toFloat), at, 1)

    def show(now: GpuRecord): Unit = ()

    def decide(self: Int, now: GpuRecord): Unit =
      import PolicyLanes.In
      val form                         = forms(self)
      val withEffort                   = two.withEffort(self)
      val seen                         = now.seen()
      val (own, opponent)              = (seen(self), seen(1 - self))
      val Vector(known, before, after) = Vector(2, 3, 4).map(now.place): @unchecked
      val decided                      = PtxExpressions.write(code, form.nodes(withEffort))(
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
      if withEffort then effort(self).take(Seq(code.two("add.rn", effort(self)(0), decided(2))))
      val first = form.decided - (if withEffort then 0 else 1)
      memory(self).take(decided.slice(first, first + form.memories))
      if form.keepsHeading then heading(self).take(Seq(decided(first + form.memories)))

    def quantity(number: Int, parameter: Int): Int =
      numbers(2)((0 until number).map(scores.parameters).sum + parameter)
    override def besides: Vector[Int] = form.efforts.flatten.map(effort(_)(0))

  override protected def efforts: Int = form.efforts.flatten.size

private object GpuOpponentKernel:
  private def numbers(form: PolicyLanes): Int = form.parameters + form.memories + 2

  /** Total number of the quantities' parameters, if they have any. */
  private def ofScores(form: TeamForm): Option[Int] =
    Some(form.scores.judged.indices.map(form.scores.parameters).sum).filter(_ > 0)
