package skein.lanes

import skein.forward.Delays

/** The worlds of one call, by number from 0. Pure functions of the number, called from any thread.
  *
  * Neighbours that share a link should return the same object: its delays are copied into the first-level
  * cache once for all of them. Otherwise the order is free.
  */
trait Worlds:
  def size: Int

  /** Whether several worlds have an equal key and link, as candidates with shared episodes do. Then they are
    * simulated together by one [[skein.lanes.timetable.Timetable]], several times as fast.
    */
  def shareEpisodes: Boolean = false

  /** Number of episodes if all candidates share them, else 0. Then a world's number divided by this is its
    * candidate's, which alone decides the policies, and the remainder is its episode's, which alone decides
    * its key and link. Only such worlds run on a GPU.
    */
  def episodesOfEach: Int = 0

  /** `skein.simd.WorldRandom.key` of the world: decides all delays. Worlds of one key and one link have equal
    * delays.
    */
  def key(world: Int): Int
  def link(world: Int): Delays
