package skein.lanes

import skein.forward.*
import skein.policy.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.testing.Unhurried
import skein.vehicle.ReducedModel

/** SIMD and the scalar engine take equal decisions in every world: [[PairAgreement]]. */
class AgreementSimulation extends munit.FunSuite, Unhurried:
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val worlds = PairKernels.WORLDS

  /** The paper's duel, with the evader's start moved from straight ahead, which is a threshold of most
    * pursuers.
    */
  private val duel = Duel.paper.copy(evader = Duel.paper.evader.copy(startY = 2), durationS = 10)

  // Some worlds at every index within a vector.
  private val many = 0 until worlds by 7
  private val some = 0 until worlds by 19

  private def drawn(family: PolicyFamily)(random: SplitMix64): Policy =
    family.policy(family.space.at(Vector.fill(family.space.dimension)(random.nextDouble())))

  private val pursuers: Seq[(String, SplitMix64 => Policy)] =
    PolicyFamily.all.filter(_.roles(Role.Pursuer)).map(family =>
      family.name -> drawn(family)
    ) ++ UnseenPolicySuite.Unseen
  private val evaders: Seq[(String, SplitMix64 => Policy)] = Seq(
    "paper-evader"     -> drawn(PolicyFamily.paperEvader),
    "chauffeur-evader" -> drawn(PolicyFamily.chauffeurEvader)
  )

  private def each(seed: Long, draw: SplitMix64 => Policy): Int => Policy =
    val random = SplitMix64(seed)
    Vector.fill(worlds)(draw(random))

  for
    (pursuer, drawPursuer) <- pursuers
    (evader, drawEvader)   <- evaders
    timing                 <-
      Seq(LoopTiming.Stream(), LoopTiming.Sequential(), LoopTiming.Predictive(predictor = lag.predictor))
  do
    test(s"$pursuer against $evader, ${timing.productPrefix}: equal decisions in each world compared"):
      PairAgreement
        .shared(duel, timing, lag, DelayTable.vpn, WorldRandom.key(2, 0, 0))(
          each(19, drawPursuer),
          each(23, drawEvader)
        )
        .check("seeds 19 and 23", many)

  for (pursuer, draw) <- pursuers do
    test(s"$pursuer, separate delays in each world: equal decisions in each world compared"):
      for timing <- Seq(LoopTiming.Stream(), LoopTiming.Sequential(), LoopTiming.Futures()) do
        PairAgreement
          .alone(duel, timing, lag, _ => DelayTable.vpn, WorldRandom.key(2, 1, _))(
            each(29, draw),
            each(31, drawn(PolicyFamily.paperEvader))
          )
          .check(s"$timing, seeds 29 and 31", some)

  private val vehicles = Seq[(String, VelocityResponse)](
    "no lag"        -> VelocityResponses.Ideal,
    "drag"          -> PlantResponse(ReducedModel.AirSim),
    "drag and turn" -> PlantResponse(ReducedModel(0.95, 0.9, 0.04, 0.5, 0.02)),
    "a bicycle"     -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
    "the quadrotor" -> VelocityResponses.quadrotor()
  )
  private val trend = UnseenPolicySuite.Unseen.toMap.apply("memory")

  for
    (name, vehicle) <- ("lag" -> lag) +: vehicles
    timing <- Seq(LoopTiming.Paused(), LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream())
    // Above, the others fly with it.
    if name != "lag" || timing.isInstanceOf[LoopTiming.Paused] || timing.isInstanceOf[LoopTiming.Futures]
  do
    test(s"with $name, ${timing.productPrefix}: equal decisions in each world compared"):
      for draw <- Seq(drawn(PolicyFamily.paperPursuer), trend) do
        PairAgreement
          .shared(duel, timing, vehicle, DelayTable.vpn, WorldRandom.key(2, 2, 0))(
            each(37, draw),
            each(41, drawn(PolicyFamily.paperEvader))
          )
          .check("seeds 37 and 41", some)

  for
    (name, vehicle) <- vehicles if name != "the quadrotor"
    timing          <- Seq(LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream())
  do
    test(
      s"with $name, ${timing.productPrefix}, separate delays in " +
        "each world: equal decisions in each world compared"
    ):
      for draw <- Seq(drawn(PolicyFamily.paperPursuer), trend) do
        PairAgreement
          .alone(
            duel,
            timing,
            vehicle,
            world => if world % 2 == 0 then DelayTable.vpn else DelayTable.direct,
            WorldRandom.key(2, 3, _)
          )(each(43, draw), each(47, drawn(PolicyFamily.paperEvader)))
          .check("seeds 43 and 47", some)
