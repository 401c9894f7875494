"""A network that knows the answer: what decoding makes of it must be the truth again."""

import numpy as np

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.models.particulate.decoding import assigned
from asset_factory.factory.models.particulate.prediction import MotionClass, Prediction
from asset_factory.factory.models.particulate.proxy import proxy_of
from asset_factory.factory.models.particulate.sampling import sample
from asset_factory.factory.models.particulate.surface import Surface

SURE = 12.0
PARTS = 16


class Oracle:
    """Answers for one articulation as a perfect network would, or with mistakes asked for.

    ``queries[i]`` is the query that speaks for part ``i``. ``wrong`` labels that share of points at
    random.
    """

    def __init__(self, truth, config, wrong=0.0, offset=0.0, change=None):
        self.truth = truth
        self.config = config
        self.wrong = wrong
        self.offset = offset
        self.change = change
        self.queries = list(np.random.default_rng(5).permutation(PARTS)[: len(truth.parts)])
        self.owner = face_parts(truth)
        self.calls = 0

    def __call__(self, shown, context, least_confidence=0.0):
        points = shown.points
        seen = self._sample(self.calls)
        self.calls += 1
        box = seen.box
        cloud = seen.cloud
        assert np.array_equal(points, box.inside(cloud.points))
        noise = np.random.default_rng(self.calls)
        part = self.owner[cloud.faces]
        part = np.where(
            noise.random(len(part)) < self.wrong,
            noise.integers(0, len(self.queries), len(part)),
            part,
        )
        mask = np.zeros((len(points), PARTS))
        mask[np.arange(len(points)), np.asarray(self.queries)[part]] = SURE
        fields = self._joints(box)
        fields["mask_logits"] = mask
        if self.change:
            self.change(fields, self.queries, self.calls - 1)
        asked = assigned(fields["mask_logits"], least_confidence).parts
        place = fields.pop("place")[asked]
        unit = fields["revolute_direction"][asked]
        along = np.einsum("ij,ij->i", points - place, unit)
        return Prediction(**fields, closest_points=place + along[:, None] * unit)

    def _sample(self, number):
        mesh = self.truth.mesh
        c = self.config
        proxy = proxy_of(Surface.of(mesh.vertices, mesh.faces), c.max_faces)
        assert proxy.vertex is None, "the oracle knows whole meshes only"
        rng = np.random.default_rng((c.seed, number))
        return sample(proxy.surface, c.points, c.context_points, c.max_faces, rng)

    def _joints(self, box):
        rng = np.random.default_rng(3)
        f = {
            "hierarchy_logits": np.full((PARTS, PARTS), -SURE),
            "motion_logits": np.zeros((PARTS, 4)),
            "revolute_direction": rng.normal(size=(PARTS, 3)),
            "revolute_range": rng.normal(size=(PARTS, 2)),
            "prismatic_direction": rng.normal(size=(PARTS, 3)),
            "prismatic_range": rng.normal(size=(PARTS, 2)),
            "place": np.zeros((PARTS, 3)),
        }
        f["motion_logits"][:, MotionClass.FIXED] = SURE
        for joint in self.truth.joints:
            query = self.queries[joint.child]
            f["hierarchy_logits"][self.queries[joint.parent], query] = SURE
            slides = joint.kind is JointKind.PRISMATIC
            kind = MotionClass.PRISMATIC if slides else MotionClass.REVOLUTE
            way = "prismatic" if slides else "revolute"
            limits = np.array([joint.lower, joint.upper]) / (box.size if slides else 1.0)
            f["motion_logits"][query] = SURE * (np.arange(4) == kind)
            f[f"{way}_direction"][query] = joint.axis
            f[f"{way}_range"][query] = limits + self.offset
            if not slides:
                f["place"][query] = box.inside(joint.origin[None])[0]
        return f
