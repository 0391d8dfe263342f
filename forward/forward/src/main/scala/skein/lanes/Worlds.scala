package skein.lanes

import skein.forward.Delays

/** The worlds of one call, by number from 0. Pure functions of the number, called from any thread.
  *
  * Neighbours that share a link should return the same object: it is copied into the first-level cache once
  * for all of them. Otherwise the order is free.
  */
trait Worlds:
  def size: Int

  /** Whether several worlds have the same key and the same link, as candidates that meet the same episodes
    * do. Then they fly together through one [[skein.lanes.timetable.Timetable]], several times as fast.
    */
  def shareEpisodes: Boolean = false

  /** Where every candidate flies through the same episodes, how many these are: then a world's number over
    * this is its candidate's, which alone decides who flies, and the rest is its episode's, which alone
    * decides its key and link. Otherwise 0. Only such worlds fly on a GPU.
    */
  def episodesOfEach: Int = 0

  /** `skein.simd.WorldRandom.key` of the world: decides all delays. Worlds of one key and one link meet the
    * same delays.
    */
  def key(world: Int): Int
  def link(world: Int): Delays
