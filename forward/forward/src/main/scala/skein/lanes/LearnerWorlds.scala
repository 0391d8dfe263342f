package skein.lanes

import skein.lanes.timetable.TimetableKernel

/** Worlds of one team that stop whenever learners are to decide. Learners and judged numbers are counted in
  * the order in which the worlds were made for them. Mutable; one thread at a time.
  */
trait LearnerWorlds extends AutoCloseable:
  /** Whether a world can be restarted while the others go on. */
  def restartAlone: Boolean

  /** Begins a run, of which nothing is simulated yet; [[restart]] says where its vehicles are.
    *
    * @param draw of the messages' delays
    * @param untilS time of the last score that counts
    */
  def start(draw: Long, untilS: Float): Unit

  /** Restarts a vehicle in one world: it rests at its start, in all readings, also those on their way, and
    * was commanded along its heading before. Requests and commands on their way stay: the loop runs already.
    */
  def restart(world: Int, vehicle: Int, northM: Float, eastM: Float, headingRad: Float): Unit

  /** Simulates until learners are to decide; false at the end of the run. */
  def flyOn(): Boolean

  def isDue(learner: Int): Boolean

  /** Writes what a learner that is due observes: [[LearnerPolicy.Fields]] rows of [[LearnerWorlds.Most]]
    * worlds.
    */
  def observe(learner: Int, into: Array[Float]): Unit

  /** Sets how much a learner that is due turns, by world; see [[LearnerPolicy]]. */
  def turn(learner: Int, numbers: Array[Float]): Unit

  /** Makes the due decisions. */
  def decide(): Unit

  /** Time of the last score, since the run's start, s. */
  def scoredAtS: Float

  /** Writes a judged number by world, since [[forgetScores]]: the newest or least value, or the sum of all.
    */
  def soFar(number: Int, into: Array[Float]): Unit

  /** Forgets all scores but the newest values. */
  def forgetScores(): Unit

  /** Forgets one world's scores but the newest values, after a restart of that world. */
  def forgetScores(world: Int): Unit

  def close(): Unit = ()

object LearnerWorlds:
  /** Most worlds that fly together. */
  val Most: Int = TimetableKernel.WORLDS
