from __future__ import annotations

from typing import Any

from django.urls import URLPattern, URLResolver, include, path, re_path
from django.views.decorators.gzip import gzip_page
from drf_spectacular.views import SpectacularAPIView

# Importing it tells drf-spectacular about the tokens.
from gtm_hit.api import (
    calibration,
    calibration_versions,
    campaign_people,
    campaigns,
    drift,
    gold,
    jobs,
    outbox,
    pay,
    platform,
    proposals,
    qualifications,
    releases,
    review,
    roles,
    scores,
    stitching,
    work,
)
from gtm_hit.api.common import schema  # noqa: F401
from gtm_hit.api.common.authentication import BearerAuthentication, StaffMay, StaffSession
from gtm_hit.api.common.docs import DocsView
from gtm_hit.api.common.missing import MissingView
from gtm_hit.api.datasets import importing, listing, videos
from gtm_hit.api.desk import adjusting as desk_adjusting
from gtm_hit.api.desk import boards, desks, lenses
from gtm_hit.api.desk import checking as desk_checking
from gtm_hit.api.desk import ground as desk_ground
from gtm_hit.api.desk import placing as desk_placing
from gtm_hit.api.quality import comparing, statistics
from gtm_hit.api.sync import drafts as syncs
from gtm_hit.api.sync import pictures as sync_pictures
from gtm_hit.api.workbench import decision, frames, tutorial
from gtm_hit.api.workbench.grids import GridView
from gtm_hit.api.workbench.images import ImageView
from gtm_hit.api.workbench.places import IN_LAYER, layer_start_place
from gtm_hit.api.workbench.proposals import ProposalsView, RefusalsView, SnapView
from gtm_hit.api.workbench.rectangles import RectanglesView
from gtm_hit.api.workbench.submission import SubmitView

staff: dict[str, Any] = {
    "authentication_classes": [BearerAuthentication, StaffSession],
    "permission_classes": [StaffMay],
}
# Scenes and frames are long and hold nothing secret that a stranger could guess by their length.
assignment = [
    path("scene/", gzip_page(frames.SceneView.as_view())),
    path("frames/", gzip_page(frames.AssignmentFrames.as_view())),
    path("frames/<int:number>/", frames.FrameView.as_view()),
    path("frames/<int:number>/history/", frames.HistoryView.as_view()),
    path("rectangles/", RectanglesView.as_view()),
    path("proposals/", gzip_page(ProposalsView.as_view())),
    path("refusals/", RefusalsView.as_view()),
    path("snap/", SnapView.as_view()),
    path("submit/", SubmitView.as_view()),
    path("comments/", decision.AssignmentComments.as_view()),
    path("comments/<int:pk>/", decision.AssignmentComment.as_view()),
    path("decision/", decision.AssignmentDecision.as_view()),
    path("appeal/", decision.AssignmentAppeal.as_view()),
]
START: dict[str, Any] = {**IN_LAYER, "find": layer_start_place}
layer = [
    path("scene/", gzip_page(frames.SceneView.as_view(**START))),
    path("frames/", gzip_page(frames.LayerFrames.as_view(**IN_LAYER))),
    path("frames/<int:number>/", frames.FrameView.as_view(**IN_LAYER)),
    path("frames/<int:number>/history/", frames.HistoryView.as_view(**IN_LAYER)),
    path("rectangles/", RectanglesView.as_view(**IN_LAYER)),
    path("proposals/", gzip_page(ProposalsView.as_view(**IN_LAYER))),
    path("refusals/", RefusalsView.as_view(**IN_LAYER)),
    path("snap/", SnapView.as_view(**IN_LAYER)),
]
# The same for a part of a long layer: the workbench opens no more of it.
one_part = [
    path("scene/", gzip_page(frames.SceneView.as_view(**START, schema=None))),
    path("frames/", gzip_page(frames.LayerFrames.as_view(**IN_LAYER, schema=None))),
    path("frames/<int:number>/", frames.FrameView.as_view(**IN_LAYER, schema=None)),
    path("frames/<int:number>/history/", frames.HistoryView.as_view(**IN_LAYER, schema=None)),
    path("rectangles/", RectanglesView.as_view(**IN_LAYER, schema=None)),
    path("proposals/", gzip_page(ProposalsView.as_view(**IN_LAYER, schema=None))),
    path("refusals/", RefusalsView.as_view(**IN_LAYER, schema=None)),
    path("snap/", SnapView.as_view(**IN_LAYER, schema=None)),
]
learning = [
    path("scene/", gzip_page(tutorial.TutorialScene.as_view())),
    path("frames/", gzip_page(tutorial.TutorialFrames.as_view())),
    path("frames/<int:number>/", tutorial.TutorialFrame.as_view()),
    path("check/", tutorial.TutorialCheck.as_view()),
    path("done/", tutorial.TutorialDone.as_view()),
]
one_layer: list[URLPattern | URLResolver] = [
    path("", listing.OneLayer.as_view()),
    path("annotations/", listing.Annotations.as_view()),
    path("statistics/", statistics.Statistics.as_view()),
    path("statistics/numbers.csv", statistics.StatisticsTable.as_view()),
    path("statistics/<slug:figure>.<slug:kind>", statistics.StatisticsFigure.as_view()),
    path("exports/", releases.Exports.as_view()),
    path("missing/", proposals.MissingPeople.as_view()),
]
campaign_pay: list[URLPattern | URLResolver] = [
    path("pay/", pay.Pay.as_view()),
    path("pay/bonuses/", pay.Bonuses.as_view()),
    path("pay/payments/", pay.Payments.as_view()),
    path("pay/ledger/", pay.Ledger.as_view()),
    path("pay/ledger/<int:pk>/take-back/", pay.TakeBack.as_view()),
    path("pay/<slug:what>.csv", pay.PayTable.as_view()),
    path("outbox/", outbox.Outbox.as_view()),
    path("outbox/payouts/", outbox.Payouts.as_view()),
    path("outbox/return-requests/", outbox.ReturnRequests.as_view()),
    path("outbox/send/", outbox.Send.as_view()),
    path("outbox/<int:pk>/", outbox.OneRow.as_view()),
    path("outbox/files/<slug:what>.csv", outbox.HandoverFile.as_view()),
    path("outbox/files/<slug:what>/done/", outbox.HandoverDone.as_view()),
    path("outbox/submissions/", outbox.Submissions.as_view()),
    path("platform/", platform.Account.as_view()),
    path("platform/draft/", platform.DraftStudy.as_view()),
    path("platform/study/", platform.ChangeStudy.as_view()),
    path("platform/messages/", platform.Messages.as_view()),
]
one_campaign: list[URLPattern | URLResolver] = [
    path("", campaigns.OneCampaign.as_view()),
    path("step/", campaigns.CampaignStep.as_view()),
    path("course/", campaigns.CampaignCourse.as_view()),
    path("links/", campaign_people.CampaignLinks.as_view()),
    path("links/<int:pk>/", campaign_people.OneCampaignLink.as_view()),
    path("workers/", campaign_people.CampaignWorkers.as_view()),
    path("workers/<str:worker>/", campaign_people.OneCampaignWorker.as_view()),
]
one_dataset: list[URLPattern | URLResolver] = [
    path("", listing.OneDataset.as_view()),
    path("cameras/", listing.Cameras.as_view()),
    path("frames/", listing.Frames.as_view()),
    path("layers/", listing.Layers.as_view()),
    path("layers/<str:name>/", include(one_layer)),
    path("evaluation/", comparing.Evaluation.as_view()),
    path("evaluation/frames/", comparing.EvaluationFrames.as_view()),
    path("evaluation/frames/<int:number>/", comparing.EvaluationFrame.as_view()),
    path("agreement/", comparing.Agreement.as_view()),
    path("calibrations/", calibration.Calibrations.as_view()),
    path("calibrations/versions/", calibration_versions.Versions.as_view()),
    path("calibrations/versions/<int:number>/", calibration_versions.OneVersion.as_view()),
    path("calibrations/differences/", calibration_versions.Differences.as_view()),
    path("calibrations/<int:pk>/", calibration.OneCalibration.as_view()),
    path("calibrations/<int:pk>/confirm/", calibration.ConfirmCalibration.as_view()),
    path("drift/", drift.DriftOfDataset.as_view()),
    path("proposals/", proposals.Runs.as_view()),
    path("proposals/<int:number>/", proposals.OneRun.as_view()),
    path("proposals/<int:number>/layer/", proposals.RunLayer.as_view()),
    path("annotation-imports/", importing.AnnotationImports.as_view()),
    path("roles/", roles.DatasetRoles.as_view()),
    path("roles/take/", roles.TakeDatasetRole.as_view()),
    path("batches/", work.Batches.as_view()),
    path("link/", work.Link.as_view()),
    path("progress/", work.Progress.as_view()),
    path("assignments/", work.Assignments.as_view()),
    path("stitching/", stitching.Stitching.as_view()),
    path("stitching/conflicts/", stitching.Conflicts.as_view()),
    path("stitching/conflicts/<int:pk>/", stitching.OneConflict.as_view()),
    path("stitching/conflicts/<int:pk>/decide/", stitching.DecideConflict.as_view()),
    path("stitching/conflicts/<int:pk>/undo/", stitching.UndoConflict.as_view()),
    path("campaigns/<str:name>/", include(campaign_pay)),
    path("reviews/", review.Reviews.as_view()),
    path("reviews/<int:pk>/", review.OneReview.as_view()),
    path("reviews/<int:pk>/differences/", gzip_page(review.ReviewDifferences.as_view())),
    path("reviews/<int:pk>/decision/", review.Decision.as_view()),
    path("reviews/<int:pk>/comments/", review.ReviewComments.as_view()),
    path("reviews/<int:pk>/comments/<int:comment>/", review.ReviewComment.as_view()),
    path("reviews/<int:pk>/mend/", review.ReviewMend.as_view()),
    path("campaigns/", campaigns.Campaigns.as_view()),
    path("campaigns/<str:name>/", include(one_campaign)),
    path("releases/", releases.Releases.as_view()),
    path("releases/<int:number>/", releases.OneRelease.as_view()),
    path("releases/<int:number>/download/", releases.DownloadRelease.as_view()),
    path("releases/<int:number>/files/<str:name>", releases.ReleaseFile.as_view()),
]
one_dataset += [
    path("qualifications/", qualifications.Qualifications.as_view()),
    path("qualifications/<str:name>/grants/", qualifications.Grants.as_view()),
    path("qualifications/<str:name>/tries/", qualifications.Tries.as_view()),
    path("campaigns/<str:name>/gold/", gold.Gold.as_view()),
    path("campaigns/<str:name>/planted-faults/", gold.PlantedFaults.as_view()),
    path("campaigns/<str:name>/required-qualifications/", gold.RequiredQualifications.as_view()),
    path("campaigns/<str:name>/scores/", scores.Scores.as_view()),
    path("campaigns/<str:name>/suspicion/", scores.SuspiciousAssignments.as_view()),
]
one_desk: list[URLPattern | URLResolver] = [
    path("", desks.OneDesk.as_view()),
    path("adjust/", gzip_page(desk_adjusting.Adjust.as_view())),
    path("adjust/ba_problem.txt", gzip_page(desk_adjusting.DeskProblemFile.as_view())),
    path("adjust/pos.zip", desk_adjusting.DeskPosFiles.as_view()),
    path("adjust/decisions/", desk_adjusting.DecideClick.as_view()),
    path("adjust/files/", desk_adjusting.ClickFiles.as_view()),
    path("adjust/files/<str:digest>/", desk_adjusting.OneClickFile.as_view()),
    path("adjust/leave/", desk_adjusting.LeaveAdjustment.as_view()),
    path("adjust/results/<int:result>/", gzip_page(desk_adjusting.OneAdjustment.as_view())),
    path("adjust/results/<int:result>/use/", desk_adjusting.UseAdjustment.as_view()),
    path("cameras.json", desk_placing.DeskCamerasJson.as_view()),
    path("calibrations.zip", desk_placing.DeskFolder.as_view()),
    path("check/", gzip_page(desk_checking.Check.as_view())),
    path("compare/", desk_placing.CompareDesk.as_view()),
    path("cameras/", desks.DeskCameras.as_view()),
    path("cameras/<str:camera>/", desks.OneDeskCamera.as_view()),
    path("cameras/<str:camera>/boards/", boards.Boards.as_view()),
    path("cameras/<str:camera>/boards/search/", boards.SearchBoards.as_view()),
    path("cameras/<str:camera>/boards/<int:picture>/", boards.OneBoardPicture.as_view()),
    path("cameras/<str:camera>/clicks/", desk_ground.PairsFile.as_view()),
    path("cameras/<str:camera>/clicks/<str:point>/", desk_ground.OneClick.as_view()),
    path("cameras/<str:camera>/lens/", lenses.DeskLens.as_view()),
    path("cameras/<str:camera>/lens/file/", lenses.DeskLensFile.as_view()),
    path("cameras/<str:camera>/lens/choose/", boards.ChooseViews.as_view()),
    path("cameras/<str:camera>/lens/model/", boards.SolveModel.as_view()),
    path("cameras/<str:camera>/lens/undistorted.jpg", boards.UndistortedPicture.as_view()),
    path("cameras/<str:camera>/lens/in-place/", lenses.DeskLensInPlace.as_view()),
    path("cameras/<str:camera>/picture/", desk_ground.GroundPicture.as_view()),
    path("ground/", gzip_page(desk_ground.Ground.as_view())),
    path("kept.csv", desk_checking.KeptCsv.as_view()),
    path("kept/", gzip_page(desk_checking.KeptPoints.as_view())),
    path("kept/file/", desk_checking.KeptFile.as_view()),
    path("kept/named/<str:point>/", desk_checking.OneKeptPoint.as_view()),
    path("kept/named/<str:point>/clicks/<str:camera>/", desk_checking.KeptClickView.as_view()),
    path("points/file/", desk_ground.PointsFile.as_view()),
    path("points/grid/", desk_ground.PointsGrid.as_view()),
    path("points/named/<str:point>/", desk_ground.OnePoint.as_view()),
    path("undo/", desk_ground.Undo.as_view()),
    path("redo/", desk_ground.Redo.as_view()),
    re_path(r"^pictures/(?P<digest>[0-9a-f]{64})\.jpg$", desks.DeskImage.as_view(), name="desk-picture"),
]
one_sync: list[URLPattern | URLResolver] = [
    path("", syncs.OneSync.as_view()),
    path("guess/", syncs.GuessSync.as_view()),
    path("guess/take/", syncs.TakeSyncGuess.as_view()),
    path("offsets.txt", syncs.SyncOffsets.as_view()),
    path("undo/", syncs.UndoSync.as_view()),
    path("redo/", syncs.RedoSync.as_view()),
    path("videos/<int:video>/picture.jpg", sync_pictures.SyncPicture.as_view()),
    path("videos/<int:video>/strip.jpg", sync_pictures.SyncStrip.as_view()),
]
scripts: list[URLPattern | URLResolver] = [
    path("calibration-board.<slug:kind>", boards.BoardSheet.as_view()),
    path("calibration-desks/", desks.Desks.as_view()),
    path("calibration-desks/<slug:desk>/", include(one_desk)),
    path("datasets/", listing.Datasets.as_view()),
    path("datasets/<slug:slug>/", include(one_dataset)),
    path("sources/", importing.Sources.as_view()),
    path("uploads/", importing.Uploads.as_view()),
    path("imports/", importing.Imports.as_view()),
    path("video-imports/", videos.VideoImports.as_view()),
    path("video-syncs/", syncs.Syncs.as_view()),
    path("video-syncs/<int:pk>/", include(one_sync)),
    path("evaluations/", comparing.TextFiles.as_view()),
    path("roles/", roles.Roles.as_view()),
    path("roles/take/", roles.TakeRole.as_view()),
    path("jobs/", jobs.Jobs.as_view()),
    path("jobs/<int:pk>/", jobs.OneJob.as_view()),
    path("jobs/<int:pk>/cancel/", jobs.CancelJob.as_view()),
    path("jobs/<int:pk>/retry/", jobs.RetryJob.as_view()),
    path("jobs/<int:pk>/download/", jobs.DownloadJob.as_view()),
    path("jobs/<int:pk>/delete-files/", jobs.DeleteFiles.as_view()),
]

urlpatterns: list[URLPattern | URLResolver] = [
    *scripts,
    path("assignment/", include(assignment)),
    path("layers/<int:layer>/", include(layer)),
    path("layers/<int:layer>/from/<int:first>/", include(one_part)),
    path("tutorial/", include(learning)),
    re_path(r"^images/(?P<digest>[0-9a-f]{64})\.jpg$", ImageView.as_view(), name="picture"),
    re_path(r"^grids/(?P<digest>[0-9a-f]{64})\.gz$", GridView.as_view()),
    path("schema/", SpectacularAPIView.as_view(**staff), name="schema"),
    path("docs/", DocsView.as_view(url_name="schema", **staff), name="docs"),
    re_path("", MissingView.as_view()),
]
