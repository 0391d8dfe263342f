package skein.lanes

/** Predicts by a plant whose state is what is read of it: of each command, how many steps end under it, and
  * the numbers of the time after the last ([[PlantStages]]). The scalar reference is
  * [[skein.vehicle.PlantModel]].
  *
  * @param speedMps of a command of length 1
  */
private[lanes] final class PredictedPlants(lanes: PlantLanes, speedMps: Double) extends PredictedVehicles:
  import PredictedVehicles.WORLDS
  private val origin = Array.ofDim[Float](WORLDS)
  private val flight = StagedFlight(lanes, speedMps, origin, origin)
  private val still  = Directions(WORLDS)

  override def start(worlds: Int): Unit = flight.use(worlds)

  def predict(
      seenX: Array[Float],
      seenY: Array[Float],
      seenVx: Array[Float],
      seenVy: Array[Float],
      sent: Directions,
      reading: Int,
      into: Int,
      propagation: Propagation,
      withVelocity: Boolean
  ): Unit =
    System.arraycopy(seenX, reading, flight.state, 0, WORLDS)
    System.arraycopy(seenY, reading, flight.state, WORLDS, WORLDS)
    System.arraycopy(seenVx, reading, flight.state, 2 * WORLDS, WORLDS)
    System.arraycopy(seenVy, reading, flight.state, 3 * WORLDS, WORLDS)
    val (commands, perPart) = (propagation.commands, propagation.perPart)
    var i                   = 0
    while i < commands.length do
      val command   = commands(i)
      val commanded = if command == Propagation.Rest then still else sent
      val from      = command.max(0) * WORLDS
      if i == 0 then flight.begin(commanded, from) else flight.act(commanded, from)
      flight.flyTo(propagation.numbers, i * perPart)
      i += 1
    flight.look(seenX, seenY, seenVx, seenVy, into, withVelocity)
