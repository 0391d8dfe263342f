package skein.lanes

import skein.forward.Duelist

/** Vehicles that move by a [[skein.vehicle.Plant]], whose commands act at times of their own in each world. A piece is a step: of it the
  * state at its begin is kept, and the command, which is no direction until there was one; the vehicle rests then. The
  * scalar reference is `skein.forward.PlantVehicle`.
  */
private[lanes] final class PlantFlights(duelist: Duelist, lanes: PlantLanes, periodS: Double, keptRows: Int)
    extends PieceFlights(
      duelist,
      LaneFlights.PIECE_OWN + 2 + lanes.count,
      keptRows,
      periodS,
      lanes.plant.stepS,
      LaneFlights.PIECE_OWN
    ):
  import LaneFlights.{PIECE_OWN, PIECE_TIME, PIECE_X, PIECE_Y}
  import LaneVehicles.WORLDS

  private val Along = PIECE_OWN * WORLDS
  private val State = Along + 2 * WORLDS

  private val speed             = duelist.speed.toFloat
  private val stepS             = lanes.plant.stepS.toFloat
  private val step              = lanes.step.call
  private val see               = lanes.read.call
  private val flown             = Array.ofDim[Float](lanes.count * WORLDS)
  private val north, east, forS = Array.ofDim[Float](WORLDS)
  private val flies             = Array.ofDim[Boolean](WORLDS)
  step.input(lanes.count, north, 0)
  step.input(lanes.count + 1, east, 0)
  step.input(lanes.count + 2, forS, 0)
  step.outputs(lanes.count, flown, 0)
  see.inputs(0, lanes.count, flown, 0)

  override def rest(pieces: Array[Float]): Unit = lanes.rest(pieces, State)

  override def fly(vectors: LaneVectors, withVelocity: Boolean): Unit =
    var world = 0
    while world < WORLDS do
      val (cos, sin) = (chosen(Along + world), chosen(Along + WORLDS + world))
      val dt         = until(world) - chosen(PIECE_TIME * WORLDS + world)
      north(world) = cos * speed
      east(world) = sin * speed
      flies(world) = dt > 0 && (cos != 0 || sin != 0)
      // A plant is never stepped by no time; what comes of this step is not taken.
      forS(world) = if flies(world) then Math.min(dt, stepS) else stepS
      world += 1
    step.inputs(0, lanes.count, chosen, State)
    step()
    world = 0
    while world < WORLDS do
      if !flies(world) then
        var i = world
        while i < flown.length do
          flown(i) = chosen(State + i)
          i += WORLDS
      world += 1
    // Where a piece began is where the vehicle started: its state counts from there.
    see.input(lanes.count, chosen, PIECE_X * WORLDS)
    see.input(lanes.count + 1, chosen, PIECE_Y * WORLDS)
    see.output(0, x, 0)
    see.output(1, y, 0)
    see.output(2, vx, 0)
    see.output(3, vy, 0)
    see()

  override def begin(vectors: LaneVectors, at: Int, acts: Array[Int], commanded: Directions): Unit =
    val pieces = this.pieces
    var k      = 0
    while k < vectors.count do
      var world = vectors.first(k)
      val end   = world + skein.simd.LaneMath.LANES
      while world < end do
        if acts(world) < LaneOffers.NONE then
          pieces(at + PIECE_TIME * WORLDS + world) = until(world)
          pieces(at + Along + world) = commanded.cos(world)
          pieces(at + Along + WORLDS + world) = commanded.sin(world)
          var i = world
          while i < flown.length do
            pieces(at + State + i) = flown(i)
            i += WORLDS
        world += 1
      k += 1
