package skein.search

import skein.optimise.{CmaEs, MethodState, Scored, SearchState, RunningStats}
import skein.pickle.Fields
import upickle.default.{ReadWriter, readwriter, writeJs, read as readJson}

/** A search on disk: its question, and its current state.
  *
  * @param files [[NamedFiles.digests]] of the names in the question
  * @param probe [[ReadySearch.probe]] of the program that wrote it; empty in older files
  */
final case class SearchFile(
    version: Int,
    question: PosedSearch,
    state: SearchState,
    files: Map[String, String] = Map.empty,
    probe: Vector[RunningStats] = Vector.empty
)

object SearchFile:
  val Name           = "search.json"
  val Version        = 2
  private val onDisk = StateFile[SearchFile](Name, Version, "a search")
  export onDisk.{json, parse, read, write}

  given ReadWriter[RunningStats]        = Fields.derived
  private given ReadWriter[Scored]      = Fields.derived
  private given ReadWriter[CmaEs.State] = Fields.derived
  private given ReadWriter[MethodState] = Fields.ofCases
  private given ReadWriter[SearchState] = Fields.derived
  given ReadWriter[PosedSearch]         = readwriter[ujson.Value].bimap(
    {
      case duel: SearchQuestion => writeJs(duel)
      case team: TeamQuestion   => writeJs(team)
      case other                => throw IllegalArgumentException(s"no question of a search: $other")
    },
    json =>
      if json.obj.contains("scenario") then readJson[TeamQuestion](json) else readJson[SearchQuestion](json)
  )
  private given ReadWriter[SearchFile] = Fields.derived
