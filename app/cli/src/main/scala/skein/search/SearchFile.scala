package skein.search

import skein.optimise.{CmaEs, MethodState, Scored, SearchState, RunningStats}
import upickle.default.{ReadWriter, readwriter, writeJs, read as readJson}

/** A search on disk: its question, and its current state.
  *
  * @param files [[NamedFiles.digests]] of the names in the question
  */
final case class SearchFile(
    version: Int,
    question: SearchFile.Question,
    state: SearchState,
    files: Map[String, String] = Map.empty
)

object SearchFile:
  val Name           = "search.json"
  val Version        = 2
  private val onDisk = StateFile[SearchFile](Name, Version, "a search")
  export onDisk.{json, parse, read, write}

  type Question = SearchQuestion | TeamQuestion

  /** Names in a question, some of which may be files. */
  def named(question: Question): Seq[String] =
    val (link, conditions) = question match
      case duel: SearchQuestion => (duel.link, duel.conditions)
      case team: TeamQuestion   => (team.link, team.conditions)
    Seq(link, conditions.plant) ++ conditions.eye

  given ReadWriter[RunningStats]        = ReadWriter.derived
  private given ReadWriter[Scored]      = ReadWriter.derived
  private given ReadWriter[CmaEs.State] = ReadWriter.derived
  private given ReadWriter[MethodState] = ReadWriter.derived
  private given ReadWriter[SearchState] = ReadWriter.derived
  given ReadWriter[Question]            = readwriter[ujson.Value].bimap(
    {
      case duel: SearchQuestion => writeJs(duel)
      case team: TeamQuestion   => writeJs(team)
    },
    json =>
      if json.obj.contains("scenario") then readJson[TeamQuestion](json) else readJson[SearchQuestion](json)
  )
  private given ReadWriter[SearchFile] = ReadWriter.derived
